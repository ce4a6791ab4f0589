/// The ground's normal by the matches over time alone.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "support/consistency.h"
#include "support/motion_matches.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::Matcher;
using test::Step;

/// Squared normalised error of the own normal.
double neesOf(const MotionEstimate& found, const Step& step) {
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = step.n.cross(Eigen::Vector3d::UnitX()).normalized();
  B.col(1) = step.n.cross(B.col(0));
  const Eigen::Vector2d error = B.transpose() * (found.own_normal - step.n);
  const Eigen::Matrix2d covariance = B.transpose() * found.own_normal_covariance * B;
  return error.dot(covariance.ldlt().solve(error));
}

constexpr int kRuns = 200;

/// Mean of it over many draws of matches, with a given normal that is known to this (rad) and off by so much.
template <class Draw>
double meanNees(const Step& step, const Draw& matches, double given_stddev, double off = 0) {
  const Eigen::Vector3d e1 = step.n.cross(Eigen::Vector3d::UnitX()).normalized();
  const Eigen::Vector3d given = (step.n + std::tan(off) * e1).normalized();
  double nees = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Expected<MotionEstimate> found = test::estimate(matches(), given, given_stddev);
    EXPECT_TRUE(found && found->own_normal.allFinite()) << run;
    if (!found) return kUnknown;
    nees += neesOf(*found, step) / kRuns;
  }
  return nees;
}

const double kTolerance = test::chiSquareMeanTolerance(kRuns, 2);
constexpr double kLoose = 0.1;  // rad: as good as no normal

TEST(OwnNormal, IsAsWrongAsItClaimsWhateverNormalWasGiven) {
  const Step step = Step::make();
  const auto nees = [&step](double stddev, double off) {
    Matcher matcher(step, 21);
    return meanNees(
        step, [&] { return matcher.ground(100, 0.15); }, stddev, off);
  };
  for (const double stddev : {0.0005, 0.005, 0.1}) {
    EXPECT_LT(nees(stddev, 0), 2 + kTolerance) << stddev;
    EXPECT_GT(nees(stddev, 0), 0.65 * 2 - kTolerance) << stddev;
  }
  EXPECT_LT(nees(1 * kDegree, 1 * kDegree), 2 + kTolerance);
}

// As where a part of the ground is not the plane: taken as independent, they give a mean of 11.
TEST(OwnNormal, IsLessCertainWhereMatchesOfAPartOfTheImageAreWrongTogether) {
  constexpr int kPart = 80;
  const Step step = Step::make();
  Matcher matcher(step, 25);
  const auto draw = [&] {
    std::vector<TemporalMatch> matches = matcher.ground(200, 0.05);
    std::map<std::pair<int, int>, Eigen::Vector2d> shifts;
    for (TemporalMatch& match : matches) {
      const std::pair<int, int> part(match.now.x() / kPart, match.now.y() / kPart);
      match.then += shifts.try_emplace(part, 0.1 * matcher.draw()).first->second;
    }
    return matches;
  };
  EXPECT_LT(meanNees(step, draw, kLoose), 8);
}

TEST(OwnNormal, IsAsCertainAsTheMatchesAgreeNotAsTheyClaim) {
  const Step step = Step::make();
  Matcher matcher(step, 26);
  const auto draw = [&] {
    std::vector<TemporalMatch> matches = matcher.ground(100, 0.05);
    for (TemporalMatch& match : matches) match.covariance *= 4;
    return matches;
  };
  const double nees = meanNees(step, draw, kLoose);
  EXPECT_LT(nees, 2 + kTolerance);
  EXPECT_GT(nees, 0.65 * 2 - kTolerance);
}

// Three corners of one spot see the same noise.
TEST(OwnNormal, IsLessCertainWhereWindowsOverlap) {
  const Step step = Step::make();
  Matcher matcher(step, 27);
  const auto draw = [&] {
    std::vector<TemporalMatch> matches = matcher.ground(40, 0.05);
    for (TemporalMatch& match : matches) match.extent = 11;
    const std::vector<TemporalMatch> once = matches;
    for (int more = 0; more < 2; ++more) matches.insert(matches.end(), once.begin(), once.end());
    return matches;
  };
  EXPECT_LT(meanNees(step, draw, kLoose), 2 + kTolerance);
}

TEST(OwnNormal, ContradictsOneThatWasTrustedWrongly) {
  const Step step = Step::make();
  const Eigen::Vector3d axis = step.n.cross(Eigen::Vector3d::UnitX()).normalized();
  const Eigen::Vector3d wrong = (step.n + std::tan(1 * kDegree) * axis).normalized();
  const Expected<MotionEstimate> found =
      test::estimate(Matcher(step, 22).ground(200, 0.05), wrong, 0.02 * kDegree);
  ASSERT_TRUE(found);
  EXPECT_LT((found->normal.normalized() - wrong).norm(), 0.3 * kDegree) << "the matches outweigh it anyway";
  const double off = axis.dot(found->own_normal - wrong);
  const double stddev = std::sqrt(axis.dot(found->own_normal_covariance * axis));
  EXPECT_LT(off, -5 * stddev) << "to the true side";
  EXPECT_NEAR(axis.dot(found->own_normal), 0, 0.6 * kDegree);
}

TEST(OwnNormal, MovesWithAReadoutTimeThatIsEstimatedAsItSays) {
  constexpr double kLater = 1e-3;  // s
  const Step step = Step::make();
  std::vector<TemporalMatch> matches = Matcher(step, 31).ground(100, 0), later;
  for (TemporalMatch& match : matches) {
    const double row = match.now.y() / test::motionRig().size.height - 0.5;
    const double column = match.now.x() / test::motionRig().size.width - 0.5;
    match.by_readout = {40 * row * column, 5 + 20 * row * row};  // px/s
  }
  later = matches;
  for (TemporalMatch& match : later) match.then += kLater * match.by_readout;
  const Expected<MotionEstimate> found = test::estimate(matches, step.n, kLoose),
                                 moved = test::estimate(later, step.n, kLoose);
  ASSERT_TRUE(found && moved);
  const Eigen::Vector3d wanted = (moved->own_normal - found->own_normal) / kLater;
  ASSERT_GT(wanted.norm(), 1e-3);
  EXPECT_LT((found->readout.own_normal_by_time - wanted).norm(), 0.02 * wanted.norm())
      << found->readout.own_normal_by_time.transpose() << " instead of " << wanted.transpose();
}

TEST(OwnNormal, IsUnknownWhereNothingMoves) {
  Step step = Step::make();
  step = Step(step.now, step.now);
  const Expected<MotionEstimate> found =
      test::estimate(Matcher(step, 23).ground(100, 0.1), step.n, 0.01 * kDegree);
  ASSERT_TRUE(found);
  const bool known = found->own_normal.allFinite();
  EXPECT_FALSE(known && found->own_normal_covariance.trace() < std::pow(5 * kDegree, 2));
}

}  // namespace
}  // namespace uav_landing
