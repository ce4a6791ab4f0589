#include "rig/rig_rotation_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kStep = 0.05;                  // s between frames
constexpr double kBias = 0.02;                  // px, of a good calibration
constexpr double kRowBias = 0.03;               // px, of its lenses
constexpr double kStraight = 0.15 * kDegree;    // 1 sigma of the runway's slope
constexpr double kPlaneError = 0.02 * kDegree;  // 1 sigma of pitch in a frame

/// An approach over a plane, seen by a bent rig: as if a yaw turned the pitch and a roll changed the height
/// by h / b, which is what they do to the disparities of the middle of the image.
struct Approach {
  StereoRig rig = test::makeRig(640, 480, 1.0);
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  double slope = 0;  // of the runway's direction against the plane
  double pitch = -4 * kDegree;
  std::mt19937 random{7};

  Eigen::Matrix3d A() const {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    A(2, 1) = 1 / rig.baseline;
    A(1, 2) = -1 / rig.baseline;
    return A;
  }
  double noise(double stddev) { return std::normal_distribution<double>(0, stddev)(random); }
  GroundPlane truth(double height) const {
    GroundPlane plane;
    plane.g = normalFromPitchRoll(pitch, 0) / height;
    return plane;
  }
  GroundPlane seen(double height) {
    GroundPlane plane = truth(height);
    plane.g += A() * w;
    plane.g += Eigen::Vector3d(0, 0, noise(kPlaneError) / height);
    plane.covariance = std::pow(kPlaneError / height, 2) * Eigen::Matrix3d::Identity();
    return plane;
  }
  /// Straight ahead, below the ground plane by the slope: n.p = sin(slope).
  Eigen::Vector3d direction() const { return {0, std::sin(pitch + slope), std::cos(pitch + slope)}; }
  Eigen::Matrix3d directionCovariance() const {
    return kStraight * kStraight * Eigen::DiagonalMatrix<double, 3>(1, 1, 0).toDenseMatrix();
  }
  RigRotation vertical(double stddev) {
    RigRotation measured;
    measured.w = w + Eigen::Vector3d(noise(stddev), 0, noise(stddev));
    measured.covariance = Eigen::Vector3d(stddev * stddev, 0.01, stddev * stddev).asDiagonal();
    return measured;
  }
  RigRotationFilter::Corrected frame(RigRotationFilter& filter, int i, double height) {
    filter.advance(i * kStep);
    filter.setPrior(kBias, kRowBias);
    filter.updateVertical(vertical(0.003 * kDegree));
    RigRotationFilter::Others others;
    others.vanishing = {direction(), directionCovariance()};
    const RigRotationFilter::Corrected corrected = filter.correct(seen(height), A(), others, 3);
    filter.settle(true);
    return corrected;
  }
};

double pitchError(const GroundPlane& plane, double pitch) { return pitchOf(plane.normal()) - pitch; }

TEST(RigRotationFilter, LeavesAStraightRigAlone) {
  Approach approach;
  RigRotationFilter filter(approach.rig, 60);
  for (int i = 0; i < 200; ++i) {
    const double height = 30 - 0.1 * i;
    const GroundPlane plane = approach.frame(filter, i, height).plane;
    EXPECT_NEAR(pitchError(plane, approach.pitch), 0, 4 * kPlaneError) << i;
    EXPECT_NEAR(plane.height(), height, 0.002 * height) << i;
  }
  const RigRotation rotation = filter.rotation();
  EXPECT_LT(rotation.w.norm(), 0.02 / approach.rig.fx) << "less than the calibration's own error";
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::sqrt(rotation.covariance(i, i)), 1.1 * 0.02 / approach.rig.fx);
}

TEST(RigRotationFilter, FindsYawAndRollAndFreesPitchAndHeightOfThem) {
  Approach approach;
  approach.w = Eigen::Vector3d(0, 0.05, -0.1) * kDegree;
  approach.slope = 0.1 * kDegree;
  RigRotationFilter filter(approach.rig, 60);
  GroundPlane plane;
  const int frames = 400;
  for (int i = 0; i < frames; ++i) plane = approach.frame(filter, i, 40 - 0.08 * i).plane;
  const RigRotation rotation = filter.rotation();
  for (const int i : {1, 2}) {
    const double stddev = std::sqrt(rotation.covariance(i, i));
    EXPECT_NEAR(rotation.w[i], approach.w[i], 3 * stddev) << i;
    EXPECT_LT(stddev, 0.3 * std::abs(approach.w[i])) << i;
  }
  const double height = 40 - 0.08 * (frames - 1);
  // Uncorrected: 0.4 degrees of pitch and 1.4 % of height.
  EXPECT_NEAR(pitchError(plane, approach.pitch), 0, 0.1 * kDegree);
  EXPECT_NEAR(plane.height(), height, 0.004 * height);
  EXPECT_NEAR(plane.height(), height, 3 * std::sqrt(plane.heightVariance()));
}

GroundNormal normalWrongBy(const Approach& approach, double pitch_error, double roll_error, double stddev) {
  const Eigen::Vector3d n = normalFromPitchRoll(approach.pitch + pitch_error, roll_error);
  return {n, stddev * stddev * (Eigen::Matrix3d::Identity() - n * n.transpose())};
}

/// A good attitude sensor over nearly level ground, wrong by this.
RigRotationFilter::Others levelGround(const Approach& approach, double pitch_error, double roll_error) {
  RigRotationFilter::Others others;
  others.level = normalWrongBy(approach, pitch_error, roll_error, 0.3 * kDegree);
  return others;
}

/// What the images' motion says, with noise of this, and more of it than is claimed.
RigRotationFilter::Others movingGround(Approach& approach, double noise, double claimed) {
  RigRotationFilter::Others others;
  others.moving = normalWrongBy(approach, approach.noise(noise), approach.noise(noise), claimed);
  return others;
}

TEST(RigRotationFilter, AnAttitudeSensorShowsAYawWhereNothingElseDoes) {
  const double truth = 0.05 * kDegree;
  for (const double error : {-0.2 * kDegree, 0.0, 0.2 * kDegree}) {
    Approach approach;
    approach.w.y() = truth;
    RigRotationFilter with(approach.rig, 60), without(approach.rig, 60);
    GroundPlane plane;
    double height = 0;
    for (int i = 0; i < 400; ++i) {
      height = 40 - 0.08 * i;
      const GroundPlane seen = approach.seen(height);
      for (RigRotationFilter* filter : {&with, &without}) {
        filter->advance(i * kStep);
        filter->setPrior(kBias, kRowBias);
      }
      plane = with.correct(seen, approach.A(), levelGround(approach, error, -error), 3).plane;
      without.correct(seen, approach.A(), {}, 3);
      with.settle(true);
      without.settle(true);
    }
    EXPECT_LT(std::abs(without.rotation().w.y()), 0.1 * truth);
    const RigRotation rotation = with.rotation();
    const double stddev = std::sqrt(rotation.covariance(1, 1));
    EXPECT_NEAR(rotation.w.y(), truth, 3 * stddev) << error;
    EXPECT_NEAR(rotation.w.y(), truth, 0.3 * truth) << error;
    // 0.05 degrees of yaw turn the plane by 0.4 at 8 m.
    EXPECT_NEAR(pitchError(plane, approach.pitch), 0, 0.15 * kDegree) << error;
  }
}

// Of 5 s at 40 m. A yaw of 0.05 degrees tilts the plane by 2 degrees there.
RigRotation afterMotion(Approach& approach, double noise, double claimed, GroundPlane* plane = nullptr) {
  constexpr double kHeight = 40;
  RigRotationFilter filter(approach.rig, 60);
  for (int i = 0; i < 100; ++i) {
    filter.advance(i * kStep);
    filter.setPrior(kBias, kRowBias);
    const RigRotationFilter::Corrected corrected =
        filter.correct(approach.seen(kHeight), approach.A(), movingGround(approach, noise, claimed), 3);
    filter.settle(true);
    if (plane != nullptr) *plane = corrected.plane;
  }
  return filter.rotation();
}

TEST(RigRotationFilter, TheImagesMotionShowsAYawWhereNothingElseDoes) {
  for (const double truth : {-0.05 * kDegree, 0.005 * kDegree, 0.05 * kDegree}) {
    Approach approach;
    approach.w.y() = truth;
    GroundPlane plane;
    const RigRotation rotation = afterMotion(approach, 0.02 * kDegree, 0.02 * kDegree, &plane);
    const double stddev = std::sqrt(rotation.covariance(1, 1));
    EXPECT_NEAR(rotation.w.y(), truth, 3 * stddev) << truth;
    // At 40 m, seen five times independently against a plane, and what stays.
    const double noise = std::hypot(0.02 * kDegree, kPlaneError);
    EXPECT_NEAR(stddev, std::hypot(noise / std::sqrt(5), 0.005 * kDegree) / 40, 0.15 * stddev) << truth;
    EXPECT_NEAR(pitchError(plane, approach.pitch), 0, 0.06 * kDegree) << truth;
  }
}

TEST(RigRotationFilter, BelievesAnImagesMotionLessThatScattersMoreThanItClaims) {
  Approach approach;
  const double claimed = 0.02 * kDegree;
  const RigRotation true_claims = afterMotion(approach, claimed, claimed);
  const RigRotation rough = afterMotion(approach, 5 * claimed, claimed);
  EXPECT_GT(std::sqrt(rough.covariance(1, 1)), 1.3 * std::sqrt(true_claims.covariance(1, 1)));
  EXPECT_LT(std::abs(rough.w.y()), 3 * std::sqrt(rough.covariance(1, 1)));
}

TEST(RigRotationFilter, LearnsNothingFromAPairThatIsNotBelieved) {
  Approach approach;
  approach.w.y() = 0.05 * kDegree;
  RigRotationFilter filter(approach.rig, 60);
  filter.advance(0);
  filter.setPrior(kBias, kRowBias);
  const auto see = [&](bool believed) {
    filter.correct(approach.seen(40), approach.A(), movingGround(approach, 0, 0.01 * kDegree), 3);
    filter.settle(believed);
    return filter.rotation().w.y();
  };
  EXPECT_EQ(see(false), 0);
  filter.settle(true);
  EXPECT_EQ(filter.rotation().w.y(), 0) << "nor later";
  EXPECT_NE(see(true), 0);
}

TEST(RigRotationFilter, TheImagesMotionTurnsThePlaneByItsWeight) {
  Approach approach;
  RigRotationFilter filter(approach.rig, 60);
  filter.advance(0);
  filter.setPrior(1e-9, 0);
  const double height = 20, off = 0.02 * kDegree;
  GroundPlane seen = approach.truth(height);
  seen.covariance = std::pow(kPlaneError / height, 2) * Eigen::Matrix3d::Identity();
  RigRotationFilter::Others others;
  others.moving = normalWrongBy(approach, off, 0, kPlaneError / 2);
  const RigRotationFilter::Corrected corrected = filter.correct(seen, approach.A(), others, 3);
  EXPECT_NEAR(pitchError(corrected.plane, approach.pitch), 0.8 * off, 0.06 * off);
  const double stddev =
      std::sqrt(pitchVariance(corrected.plane.normal(), corrected.plane.normalCovariance()));
  EXPECT_NEAR(stddev, kPlaneError / std::sqrt(5), 0.1 * stddev);
  // A twentieth of the motion's noise is in the next pairs, too, and its slow error.
  const Eigen::Matrix3d common = GroundPlane{corrected.plane.g, corrected.common}.normalCovariance();
  const double lasting = 0.8 * std::hypot(0.003 * kDegree, std::sqrt(0.05) * kPlaneError / 2);
  EXPECT_NEAR(std::sqrt(pitchVariance(corrected.plane.normal(), common)), lasting, 0.1 * lasting);
  others.moving = normalWrongBy(approach, 0.5 * kDegree, 0, kPlaneError);
  const GroundPlane contradicted = filter.correct(seen, approach.A(), others, 3).plane;
  EXPECT_NEAR(pitchError(contradicted, approach.pitch), 0, 1e-3 * off);
}

TEST(RigRotationFilter, DoesNotTakeTheErrorOfAnAttitudeSensorForAYaw) {
  Approach approach;
  RigRotationFilter filter(approach.rig, 60);
  const RigRotationFilter::Others level = levelGround(approach, 0.6 * kDegree, 0.6 * kDegree);
  for (int i = 0; i < 200; ++i) {
    filter.advance(i * kStep);
    filter.setPrior(kBias, kRowBias);
    const double height = 30 - 0.1 * i;
    const GroundPlane plane = filter.correct(approach.seen(height), approach.A(), level, 3).plane;
    filter.settle(true);
    EXPECT_NEAR(pitchError(plane, approach.pitch), 0,
                4 * std::sqrt(pitchVariance(plane.normal(), plane.normalCovariance())))
        << i;
  }
  EXPECT_LT(std::abs(filter.rotation().w.y()), 0.03 / approach.rig.fx);
}

TEST(RigRotationFilter, DoesNotTakeTheRunwaysSlopeForAYaw) {
  Approach approach;
  approach.slope = kStraight;
  RigRotationFilter filter(approach.rig, 60);
  for (int i = 0; i < 200; ++i) approach.frame(filter, i, 20);
  const RigRotation rotation = filter.rotation();
  EXPECT_LT(std::abs(rotation.w.y()), 2 * std::sqrt(rotation.covariance(1, 1)));
  EXPECT_LT(std::abs(rotation.w.y()), 0.03 / approach.rig.fx);
}

TEST(RigRotationFilter, DoesNotTakeLinesThatAreMisjudgedForSecondsForAYaw) {
  // From 40 m down at 2 m/s; which lines are found changes twice.
  Approach approach;
  RigRotationFilter filter(approach.rig, 60);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    approach.slope = (i < 60 ? 0.15 : i < 130 ? -0.1 : 0) * kDegree;
    const double height = 40 - 0.1 * i;
    const GroundPlane plane = approach.frame(filter, i, height).plane;
    const RigRotation rotation = filter.rotation();
    worst = std::max(worst, std::abs(rotation.w.y()) / std::sqrt(rotation.covariance(1, 1)));
    EXPECT_NEAR(pitchError(plane, approach.pitch), 0, 0.1 * kDegree) << i;
  }
  EXPECT_LT(worst, 1.0);
}

TEST(RigRotationFilter, DoesNotAverageAwayWhatAllFramesOfASecondShare) {
  Approach approach;
  RigRotationFilter once(approach.rig, 1e9), often(approach.rig, 1e9);
  for (RigRotationFilter* filter : {&once, &often}) filter->setPrior(1.0, kRowBias);
  const double steps = 1000;
  once.advance(0);
  often.advance(0);
  once.advance(1);
  once.updateVertical(approach.vertical(0.1 * kDegree));
  for (int i = 1; i <= steps; ++i) {
    often.advance(i / steps);
    often.updateVertical(approach.vertical(0.1 * kDegree));
  }
  EXPECT_NEAR(often.rotation().covariance(2, 2) / once.rotation().covariance(2, 2), 1, 0.2);
  EXPECT_GT(std::sqrt(often.rotation().covariance(2, 2)), 0.03 * kDegree);
}

TEST(RigRotationFilter, VarianceOfThePlaneHasTheRigsShareInIt) {
  Approach approach;
  RigRotationFilter filter(approach.rig, 60);
  filter.advance(0);
  filter.setPrior(0.1, kRowBias);
  const double height = 20;
  const RigRotationFilter::Corrected corrected = filter.correct(approach.seen(height), approach.A(), {}, 3);
  // A roll by 0.1 px at the focal length turns 1 / b of g: sigma of h is h^2 cos(pitch) 0.1 / (f b).
  const double expected = height * height * std::cos(approach.pitch) * 0.1 / approach.rig.fx;
  const GroundPlane common{corrected.plane.g, corrected.common};
  EXPECT_NEAR(std::sqrt(common.heightVariance()), expected, 0.01 * expected);
  EXPECT_GT(corrected.plane.heightVariance(), common.heightVariance());
}

// Yaw and slope look the same, so that what is known of one is known of the other by its opposite.
TEST(RigRotationFilter, APlaneOfARigWhoseYawWasSeenAgainstASlopeHasTheVarianceOfSamples) {
  constexpr double kHeight = 20, kRigBias = 0.1;  // m, px
  constexpr int kRuns = 3000, kFrames = 6;
  Approach approach;
  const double rig_stddev = kRigBias / approach.rig.fx;
  double squares = 0, claimed = 0;
  for (int run = 0; run < kRuns; ++run) {
    RigRotationFilter filter(approach.rig, 1e9);
    filter.advance(0);
    filter.setPrior(kRigBias, kRowBias);
    approach.w = {0, approach.noise(rig_stddev), approach.noise(rig_stddev)};
    // A tenth of the variance of a first direction is its noise, the rest is the slope.
    const double slope = approach.noise(std::sqrt(0.9) * kStraight);
    RigRotationFilter::Corrected corrected;
    for (int i = 1; i <= kFrames; ++i) {
      // Of lines that are the same ones for 5 s, a frame a second is learned from with that much less trust.
      const double more = i < kFrames ? std::sqrt(5) : 1;
      approach.slope = slope + more * approach.noise(std::sqrt(0.1) * kStraight);
      GroundPlane seen = approach.seen(kHeight);
      seen.g.z() += std::sqrt(more * more - 1) * approach.noise(kPlaneError) / kHeight;
      RigRotationFilter::Others others;
      others.vanishing = {approach.direction(), approach.directionCovariance()};
      filter.advance(i);
      corrected = filter.correct(seen, approach.A(), others, 10);
      filter.settle(true);
    }
    squares += std::pow(pitchError(corrected.plane, approach.pitch), 2) / kRuns;
    claimed += pitchVariance(corrected.plane.normal(), corrected.plane.normalCovariance()) / kRuns;
  }
  EXPECT_NEAR(claimed / squares, 1, 0.15);
}

TEST(RigRotationFilter, LeavesOutAVerticalRotationWithoutADefiniteCovariance) {
  Approach approach;
  const double variance = 1e-10;
  for (const Eigen::Vector3d& diagonal :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(variance, 0.01, -variance),
        Eigen::Vector3d(0, 0.01, variance), Eigen::Vector3d(variance, 0.01, kUnknown)}) {
    RigRotationFilter filter(approach.rig, 60);
    filter.advance(0);
    filter.setPrior(kBias, kRowBias);
    RigRotation measured;
    measured.w = Eigen::Vector3d::Constant(kDegree);
    measured.covariance = diagonal.asDiagonal();
    filter.updateVertical(measured);
    EXPECT_EQ(filter.rotation().w.norm(), 0) << diagonal.transpose();
    approach.frame(filter, 1, 20);
    EXPECT_TRUE(filter.rotation().covariance.allFinite()) << diagonal.transpose();
  }
}

TEST(RigRotationFilter, TakesInclinedRowsForARollAsFarAsLensesAreKnownBetter) {
  const auto rollOf = [](double row_bias) {
    Approach approach;
    RigRotationFilter filter(approach.rig, 30);
    filter.advance(0);
    filter.setPrior(0.1, row_bias);
    RigRotation measured;
    measured.w = {0, 0, 0.02 * kDegree};
    measured.covariance = std::pow(1e-4 * kDegree, 2) * Eigen::Matrix3d::Identity();
    filter.updateVertical(measured);
    return filter.rotation();
  };
  const RigRotation exact = rollOf(0), usual = rollOf(kRowBias), poor = rollOf(0.3);
  EXPECT_NEAR(exact.w.z(), 0.02 * kDegree, 1e-3 * kDegree);
  EXPECT_LT(usual.w.z(), 0.8 * exact.w.z());
  EXPECT_LT(poor.w.z(), 0.1 * exact.w.z());
  EXPECT_GT(poor.covariance(2, 2), usual.covariance(2, 2));
}

TEST(RigRotationFilter, ForgetsWhatIsOldAndAllOnReset) {
  Approach approach;
  approach.w.z() = 0.1 * kDegree;
  RigRotationFilter filter(approach.rig, 10);
  int i = 0;
  for (; i < 400; ++i) approach.frame(filter, i, 20);
  EXPECT_NEAR(filter.rotation().w.z(), 0.1 * kDegree, 0.03 * kDegree);
  approach.w.z() = -0.1 * kDegree;
  for (; i < 2000; ++i) approach.frame(filter, i, 20);
  EXPECT_NEAR(filter.rotation().w.z(), -0.1 * kDegree, 0.03 * kDegree);
  filter.reset();
  EXPECT_EQ(filter.rotation().w.norm(), 0);
}

}  // namespace
}  // namespace uav_landing
