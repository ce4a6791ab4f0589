#include "motion/step/ego_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "support/consistency.h"
#include "support/motion_matches.h"

namespace uav_landing {
namespace {

using test::across;
using test::estimate;
using test::kDegree;
using test::Matcher;
using test::Movement;
using test::Pose;
using test::Step;

const StereoRig& rig() { return test::motionRig(); }

Eigen::Vector3d rotationError(const Eigen::Matrix3d& R, const Eigen::Matrix3d& truth) {
  const Eigen::AngleAxisd turn(R * truth.transpose());
  return turn.angle() * turn.axis();
}

TEST(CameraMotion, SeesPointsThenWhereTheWorldSaysTheyWere) {
  const Step step = Step::make();
  const CameraMotion motion{step.movement.R, step.t};
  std::vector<TemporalMatch> matches = Matcher(step, 1).standing(20, 0, 0);
  for (const TemporalMatch& match : matches) {
    const Eigen::Vector3d y = motion.seenThen(rig().ray(match.now.x(), match.now.y()), match.inverse_depth);
    EXPECT_NEAR((rig().project(y) - match.then).norm(), 0, 1e-9);
  }
}

TEST(EstimateMotion, IsExactOnExactMatches) {
  for (const double pitch : {-15.0, -6.0, 3.0}) {
    const Step step = Step::make(pitch);
    const Expected<MotionEstimate> found = estimate(Matcher(step, 2).ground(100, 0), step.n, 1e-3);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_LT(rotationError(found->motion.R, step.movement.R).norm(), 1e-8);
    EXPECT_LT((found->motion.t - step.t).norm(), 1e-7);
    EXPECT_LT((found->normal - step.n).norm(), 1e-7);
    EXPECT_EQ(found->inlier_count, 100);
  }
}

TEST(EstimateMotion, DoesNotFollowTheWarpsThatMatchesWereLookedForWith) {
  const Step step = Step::make();
  Matcher matcher(step, 4);
  std::vector<TemporalMatch> matches = matcher.ground(100, 0);
  matcher.findByWrongWarps(matches, 0.1);
  const Expected<MotionEstimate> found = estimate(matches, step.n, 1e-3);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_LT((found->motion.t - step.t).norm(), 1e-7);
  // What the warp alone would tell of a motion is not known to a match that follows it.
  for (TemporalMatch& match : matches) match.by_warp = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  const Expected<MotionEstimate> followed = estimate(matches, step.n, 1e-3);
  ASSERT_TRUE(followed);
  EXPECT_GT((followed->motion.t - step.t).norm(), 1e-4);
}

TEST(EstimateMotion, FindsNoMovementAndPureRotation) {
  Pose now;
  now.position = {0, 0, 5};
  now.pitch = -5 * kDegree;
  Pose turned = now;
  turned.yaw = 2 * kDegree;
  turned.pitch = -4 * kDegree;
  for (const Pose& then : {now, turned}) {
    const Step step(then, now);
    const Expected<MotionEstimate> found = estimate(Matcher(step, 3).ground(100, 0), step.n, 1e-3);
    ASSERT_TRUE(found);
    EXPECT_LT(rotationError(found->motion.R, step.movement.R).norm(), 1e-8);
    EXPECT_LT(found->motion.t.norm(), 1e-7);
  }
}

TEST(EstimateMotion, IgnoresThirtyPercentOutliers) {
  const Step step = Step::make();
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Matcher matcher(step, seed);
    std::vector<TemporalMatch> matches = matcher.ground(150, 0.1);
    const Expected<MotionEstimate> clean = estimate(matches, step.n, 1e-3);
    matcher.spoil(matches, 0.3);
    const Expected<MotionEstimate> found = estimate(matches, step.n, 1e-3);
    ASSERT_TRUE(clean && found);
    EXPECT_NEAR(found->inlier_count, 105, 20);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found->motion.t[i], step.t[i], 4.5 * std::sqrt(found->covariance(3 + i, 3 + i)));
      // No wider than fewer matches and a few of them half believed make it.
      EXPECT_LT(found->covariance(3 + i, 3 + i), 3 * clean->covariance(3 + i, 3 + i));
    }
  }
}

TEST(EstimateMotion, FindsThatOfMostMatchesWhereOthersAreAsExpected) {
  const Step step = Step::make();
  std::vector<TemporalMatch> matches = Matcher(step, 5).ground(150, 0.1);
  // Of what stands still in the picture: a part of the camera, or what the expected motion was found by.
  for (size_t i = 0; i < matches.size(); i += 3) matches[i].then = matches[i].now;
  const Expected<MotionEstimate> found =
      estimateMotion(rig(), matches, {{}, {step.n, Eigen::Matrix3d::Identity() * 1e-6}}, 12);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_LT((found->motion.t - step.t).norm(), 0.1 * step.t.norm());
  EXPECT_NEAR(found->inlier_count, 100, 10);
}

TEST(EstimateMotion, ClaimsTheScatterItHas) {
  constexpr int kRuns = 300;
  const Step step = Step::make();
  const double normal_stddev = 0.003;
  Matcher matcher(step, 5);
  double rotation = 0, translation = 0, normal = 0, joint = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<TemporalMatch> matches = matcher.ground(100, 0.15);
    const std::vector<TemporalMatch> above = matcher.standing(20, 0.15, 0.004);
    matches.insert(matches.end(), above.begin(), above.end());
    // Prior normal off by its own covariance.
    const Eigen::Vector2d a = normal_stddev * matcher.draw();
    const Eigen::Vector3d e1 = step.n.cross(Eigen::Vector3d::UnitX()).normalized(), e2 = step.n.cross(e1);
    const Eigen::Vector3d prior = (step.n + a.x() * e1 + a.y() * e2).normalized();
    const Expected<MotionEstimate> found =
        estimateMotion(rig(), matches, {{}, {prior, across(prior, normal_stddev)}}, 15);
    ASSERT_TRUE(found);
    Eigen::Matrix<double, 8, 1> error;
    error << rotationError(found->motion.R, step.movement.R), found->motion.t - step.t,
        e1.dot(found->normal.normalized() - step.n), e2.dot(found->normal.normalized() - step.n);
    Eigen::Matrix<double, 8, 9> pick = Eigen::Matrix<double, 8, 9>::Zero();
    pick.topLeftCorner<6, 6>().setIdentity();
    pick.block<1, 3>(6, 6) = e1.transpose();
    pick.block<1, 3>(7, 6) = e2.transpose();
    const Eigen::Matrix<double, 8, 8> P = pick * found->covariance * pick.transpose();
    rotation += error.head<3>().dot(P.topLeftCorner<3, 3>().ldlt().solve(error.head<3>())) / kRuns;
    translation += error.segment<3>(3).dot(P.block<3, 3>(3, 3).ldlt().solve(error.segment<3>(3))) / kRuns;
    normal += error.tail<2>().dot(P.bottomRightCorner<2, 2>().ldlt().solve(error.tail<2>())) / kRuns;
    joint += error.dot(P.ldlt().solve(error)) / kRuns;
  }
  // Robust weights and a scale that never goes below one make the claim a little larger than the scatter.
  constexpr double kLeastShare = 0.65;
  const auto expect = [&](double nees, int dof) {
    const double tolerance = test::chiSquareMeanTolerance(kRuns, dof);
    EXPECT_LT(nees, dof + tolerance);
    EXPECT_GT(nees, kLeastShare * dof - tolerance);
  };
  expect(rotation, 3);
  expect(translation, 3);
  expect(normal, 2);
  expect(joint, 8);
}

TEST(EstimateMotion, FindsOutThatMatchesClaimTooLittle) {
  constexpr int kRuns = 200;
  const Step step = Step::make();
  Matcher matcher(step, 6);
  double nees = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<TemporalMatch> matches = matcher.ground(100, 0.3);
    for (TemporalMatch& match : matches) match.covariance /= 9;
    const Expected<MotionEstimate> found = estimate(matches, step.n, 1e-5);
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->motion.t - step.t;
    nees += error.dot(found->covariance.block<3, 3>(3, 3).ldlt().solve(error)) / kRuns;
  }
  EXPECT_LT(nees, 3 + test::chiSquareMeanTolerance(kRuns, 3));
}

TEST(EstimateMotion, UsesThePriorOfTheNormal) {
  // A short step says little of the normal: then the prior decides, as far as it is trusted.
  const Step step = Step::make();
  const std::vector<TemporalMatch> matches = Matcher(step, 7).ground(60, 0.3);
  const Eigen::Vector3d wrong =
      (step.n + 0.02 * step.n.cross(Eigen::Vector3d::UnitX()).normalized()).normalized();
  const Expected<MotionEstimate> trusted = estimate(matches, wrong, 1e-4),
                                 doubted = estimate(matches, wrong, 0.2);
  ASSERT_TRUE(trusted && doubted);
  EXPECT_LT((trusted->normal.normalized() - wrong).norm(), 1e-3);
  EXPECT_LT((doubted->normal.normalized() - step.n).norm(), 0.5 * (wrong - step.n).norm());
  const auto spread = [&](const MotionEstimate& motion) {
    return motion.covariance.bottomRightCorner<3, 3>().trace();
  };
  EXPECT_LT(spread(*trusted), 2.1e-8);
  EXPECT_LT(spread(*doubted), 2 * 0.04);
  EXPECT_GT(spread(*doubted), spread(*trusted));
}

TEST(EstimateMotion, WeighsThePriorOfTheNormalAgainstTheMatches) {
  const Step step = Step::make();
  const std::vector<TemporalMatch> matches = Matcher(step, 12).ground(100, 0.05);
  const Eigen::Vector3d e1 = step.n.cross(Eigen::Vector3d::UnitX()).normalized(), e2 = step.n.cross(e1);
  Eigen::Matrix<double, 3, 2> B;
  B << e1, e2;
  const Expected<MotionEstimate> alone = estimate(matches, step.n, 0.3);
  ASSERT_TRUE(alone);
  // Each as good as the other, in the plane across the normal.
  const Eigen::Matrix2d of_matches = B.transpose() * alone->covariance.bottomRightCorner<3, 3>() * B;
  const double stddev = std::sqrt(of_matches.trace() / 2);
  const Eigen::Vector3d prior = (step.n + stddev * (1.6 * e1 - 1.2 * e2)).normalized();
  const Eigen::Matrix2d information = of_matches.inverse();
  const Eigen::Matrix2d of_prior = Eigen::Matrix2d::Identity() / (stddev * stddev);
  const Eigen::Vector2d data = B.transpose() * (alone->normal - step.n);
  const Eigen::Vector2d believed = B.transpose() * (prior - step.n);
  const Eigen::Vector2d expected =
      (information + of_prior).inverse() * (information * data + of_prior * believed);
  const Expected<MotionEstimate> found = estimate(matches, prior, stddev);
  ASSERT_TRUE(found);
  EXPECT_LT((B.transpose() * (found->normal - step.n) - expected).norm(), 0.15 * (data - believed).norm());
  EXPECT_GT((data - expected).norm(), 0.25 * (data - believed).norm());
}

TEST(EstimateMotion, TellsWhatOfItsErrorsComesFromTheNormalGiven) {
  const Step step = Step::make();
  std::vector<TemporalMatch> matches = Matcher(step, 14).ground(200, 0.01);
  // So that all count alike, and not less the more they are off: they agree far better than they claim.
  for (TemporalMatch& match : matches) match.covariance = 0.04 * Eigen::Matrix2d::Identity();
  constexpr double kStddev = 0.003, kShare = 0.1;
  const Expected<MotionEstimate> found = estimate(matches, step.n, kStddev);
  ASSERT_TRUE(found);
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  Matrix6d expected = Matrix6d::Zero();
  const Eigen::Vector3d e1 = step.n.cross(Eigen::Vector3d::UnitX()).normalized(), e2 = step.n.cross(e1);
  for (const Eigen::Vector3d& axis : {e1, e2}) {
    const Expected<MotionEstimate> other = estimate(matches, step.n + kShare * kStddev * axis, kStddev);
    ASSERT_TRUE(other);
    Vector6d change;
    change << other->motion.t - found->motion.t, other->normal - found->normal;
    change /= kShare;
    expected += change * change.transpose();
  }
  const Matrix6d of_normal = found->of_normal.bottomRightCorner<6, 6>();
  EXPECT_LT((of_normal - expected).norm(), 0.05 * expected.norm());
  // Some of it is known better by the matches, and the rest of the errors is theirs.
  EXPECT_LT((of_normal.bottomRightCorner<3, 3>().trace()), 0.9 * 2 * kStddev * kStddev);
  EXPECT_GT((found->covariance - found->of_normal).diagonal().minCoeff(), -1e-12);
}

TEST(EstimateMotion, ExpectsPointsOfUncertainDepthToMissAsMuch) {
  const Step step = Step::make();
  Matcher matcher(step, 13);
  std::vector<TemporalMatch> matches = matcher.ground(80, 0.05);
  const std::vector<TemporalMatch> vague = matcher.standing(60, 0.05, 0.04);
  matches.insert(matches.end(), vague.begin(), vague.end());
  const Expected<MotionEstimate> found = estimate(matches, step.n, 1e-3);
  ASSERT_TRUE(found);
  EXPECT_GE(found->inlier_count, 0.97 * 140);
}

TEST(EstimateMotion, UsesPointsOffTheGroundWithTheirOwnDepth) {
  const Step step = Step::make();
  Matcher matcher(step, 8);
  // Nothing on the ground at all.
  const std::vector<TemporalMatch> above = matcher.standing(100, 0, 0);
  const Expected<MotionEstimate> found = estimate(above, step.n, 1e-3);
  ASSERT_TRUE(found);
  EXPECT_LT((found->motion.t - step.t).norm(), 1e-7);
  // Taken for ground, they contradict each other.
  std::vector<TemporalMatch> confused = above;
  for (TemporalMatch& match : confused) match.on_plane = true;
  const Expected<MotionEstimate> wrong = estimate(confused, step.n, 1e-3);
  EXPECT_TRUE(!wrong || wrong->inlier_count < 80);
  // Depth known badly weighs less than depth known well.
  const Expected<MotionEstimate> vague = estimate(matcher.standing(100, 0.1, 0.1), step.n, 1e-3);
  const Expected<MotionEstimate> sharp = estimate(matcher.standing(100, 0.1, 0.001), step.n, 1e-3);
  ASSERT_TRUE(vague && sharp);
  EXPECT_GT(vague->covariance(5, 5), 4 * sharp->covariance(5, 5));
}

TEST(EstimateMotion, WeighsARotationKnownBeforehandAgainstTheMatches) {
  const Step step = Step::make();
  const std::vector<TemporalMatch> matches = Matcher(step, 17).ground(60, 0.3);
  const Expected<MotionEstimate> alone = estimate(matches, step.n, 1e-4);
  ASSERT_TRUE(alone);
  const Eigen::Vector3d off(2e-3, -1e-3, 3e-3);
  const auto with = [&](double stddev, double share = 1) {
    const RotationPrior prior{Eigen::AngleAxisd(share * off.norm(), off.normalized()) * step.movement.R,
                              stddev * stddev * Eigen::Matrix3d::Identity()};
    const auto found = estimateMotion(rig(), matches, {{}, {step.n, across(step.n, 1e-4)}, &prior}, 15);
    EXPECT_TRUE(found);
    return *found;
  };
  const Eigen::Vector3d trusted = rotationError(with(1e-6).motion.R, step.movement.R);
  EXPECT_LT((trusted - off).norm(), 1e-5);
  const MotionEstimate ignored = with(1);
  EXPECT_LT(rotationError(ignored.motion.R, alone->motion.R).norm(), 1e-5);
  // Both alike: the covariance is that of the sum of the informations, along the axis that is known worst.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(alone->covariance.topLeftCorner<3, 3>());
  const Eigen::Vector3d axis = axes.eigenvectors().col(2);
  const double variance = axes.eigenvalues()[2];
  const MotionEstimate both = with(std::sqrt(variance), 0);
  EXPECT_NEAR(axis.dot(both.covariance.topLeftCorner<3, 3>() * axis) / variance, 0.5, 0.1);
  const auto of_translation = [](const MotionEstimate& e) {
    return e.covariance.diagonal().segment(3, 3).sum();
  };
  EXPECT_LT(of_translation(both), of_translation(*alone));
}

TEST(EstimateMotion, SaysWhyThereIsNone) {
  const Step step = Step::make();
  Matcher matcher(step, 9);
  const Expected<MotionEstimate> few = estimate(matcher.ground(14, 0), step.n, 1e-3);
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().reason, Reason::kTooFewMatches);
  EXPECT_NE(few.error().detail.find("14"), std::string::npos) << few.error().detail;
  EXPECT_FALSE(estimate({}, step.n, 1e-3));
  std::vector<TemporalMatch> scattered = matcher.ground(60, 0);
  matcher.spoil(scattered, 2);
  for (TemporalMatch& match : scattered) match.then += 40 * matcher.draw();
  const Expected<MotionEstimate> none = estimate(scattered, step.n, 1e-3);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().reason, Reason::kMotionInconsistent);
}

TEST(EstimateMotion, DoesNotTakeOneTimesTheSamePointForAMotion) {
  const Step step = Step::make();
  const std::vector<TemporalMatch> same(40, Matcher(step, 10).ground(1, 0).front());
  const Expected<MotionEstimate> found = estimate(same, step.n, 1e-3);
  // A failure, or a covariance that says that nothing is known.
  if (!found) return;
  const double variance = found->covariance.block(3, 3, 3, 3).trace();
  EXPECT_GT(variance, found->motion.t.squaredNorm());
}

TEST(EstimateMotion, IsDeterministic) {
  const Step step = Step::make();
  Matcher matcher(step, 11);
  std::vector<TemporalMatch> matches = matcher.ground(120, 0.2);
  matcher.spoil(matches, 0.3);
  const Expected<MotionEstimate> a = estimate(matches, step.n, 1e-3), b = estimate(matches, step.n, 1e-3);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->motion.t, b->motion.t);
  EXPECT_EQ(a->covariance, b->covariance);
}

}  // namespace
}  // namespace uav_landing
