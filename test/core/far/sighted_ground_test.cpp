#include "far/sighted_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rig/rig_rotation.h"
#include "support/ground_matches.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180, kCalibrated = 0.02, kHeight = 40;  // px, m

/// Pairs of a flight over level ground, 10 a second. The right camera is turned by a yaw that moves
/// everything by `bias` pixels.
class Flight {
 public:
  explicit Flight(double bias, double noise = 0.01)
      : rig(test::usualRig()), known(rig), bias_(bias), noise_(noise) {}

  /// The ground of the last of so many pairs.
  KnownGround fly(int pairs, bool motion_known = true) {
    KnownGround ground;
    for (int i = 0; i < pairs; ++i) {
      const double pitch = -3 * kDegree + 0.5 * kDegree * std::sin(0.3 * count_);
      truth = normalFromPitchRoll(pitch, 0) / kHeight;
      StereoDepthResult stereo;
      stereo.stamp = 10 + 0.1 * count_++;
      stereo.disparity_bias_stddev = kCalibrated;
      const Eigen::Vector3d turned(0, bias_ / rig.fx, 0);
      stereo.plane.g = truth + planeByRotation(rig, test::matchesOn(rig, truth), PlaneVector(truth)) * turned;
      // Noise of all disparities d = f b g.r alike is noise of g_z.
      stereo.plane.g.z() += noise_ * normal_(random_) / rig.fb();
      stereo.plane.covariance = std::pow(1e-3 / kHeight / kHeight, 2) * Eigen::Matrix3d::Identity();
      stereo.plane.covariance(2, 2) = (kCalibrated * kCalibrated + noise_ * noise_) / (rig.fb() * rig.fb());
      stereo.points = test::matchesOn(rig, stereo.plane.g);
      measured = stereo.plane;
      ground = known.of(stereo, true, {});
      ApproachAngleResult::Motion motion;
      motion.normal = truth.normalized();
      motion.normal_covariance = std::pow(0.02 * kDegree, 2) * Eigen::Matrix3d::Identity();
      if (!motion_known) motion.failure = {Reason::kNotYet, "for the test"};
      known.learn(motion);
    }
    return ground;
  }

  /// In the middle of the image.
  double biasOf(const KnownGround& ground) const {
    return disparityByRotation(rig, rig.cx_right, rig.cy).dot(ground.right.turned.w);
  }
  double biasStddevOf(const KnownGround& ground) const {
    const Eigen::RowVector3d by_rig = disparityByRotation(rig, rig.cx_right, rig.cy);
    return std::sqrt(by_rig.dot(ground.right.turned.covariance * by_rig.transpose()));
  }

  StereoRig rig;
  SightedGround known;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
  GroundPlane measured;

 private:
  double bias_, noise_;
  int count_ = 0;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

TEST(SightedGround, TheNormalOfTheMotionTellsHowTheRightCameraIsTurned) {
  for (const double bias : {-0.03, 0.0, 0.02, 0.1}) {
    Flight flight(bias);
    const KnownGround ground = flight.fly(100);
    EXPECT_NEAR(flight.biasOf(ground), bias, 0.015);
    EXPECT_LT(flight.biasStddevOf(ground), 0.7 * kCalibrated);
    EXPECT_LT(std::abs(flight.biasOf(ground) - bias), 3 * flight.biasStddevOf(ground));
  }
}

TEST(SightedGround, IsFreeOfIt) {
  Flight flight(0.1, 0);
  const KnownGround ground = flight.fly(100);
  const double off = pitchOf(flight.measured.normal()) - pitchOf(flight.truth.normalized());
  EXPECT_GT(std::abs(off), 0.3 * kDegree);
  EXPECT_LT(std::abs(pitchOf(ground.plane.normal()) - pitchOf(flight.truth.normalized())),
            0.15 * std::abs(off));
  ASSERT_TRUE(ground.normal);
  EXPECT_EQ(ground.normal->vector(), ground.plane.normal());
}

TEST(SightedGround, AsLongAsNoMotionIsSeenTheCalibrationIsBelieved) {
  Flight flight(0.1);
  const KnownGround ground = flight.fly(20, false);
  EXPECT_EQ(flight.biasOf(ground), 0);
  EXPECT_NEAR(flight.biasStddevOf(ground), kCalibrated, 0.1 * kCalibrated);
  // A yaw moves the sides of the image by more than the middle.
  EXPECT_NEAR(ground.plane.covariance(2, 2) / flight.measured.covariance(2, 2), 1, 0.3);
}

TEST(SightedGround, ATimeJumpForgetsTheRig) {
  Flight flight(0.1);
  flight.fly(100);
  StereoDepthResult earlier;
  earlier.stamp = 5;
  earlier.disparity_bias_stddev = kCalibrated;
  earlier.failure = {Reason::kTooFewMatches, "for the test"};
  EXPECT_EQ(flight.biasOf(flight.known.of(earlier, false, {})), 0);
}

TEST(SightedGround, WithoutAPlaneTheAttitudeSensorGivesTheNormal) {
  SightedGround known(test::usualRig());
  StereoDepthResult stereo;
  stereo.stamp = 1;
  stereo.failure = {Reason::kTooFewMatches, "for the test"};
  AttitudePrior imu;
  imu.failure = {};
  imu.normal = normalFromPitchRoll(-2 * kDegree, 1 * kDegree);
  imu.normal_covariance =
      std::pow(0.3 * kDegree, 2) * (Eigen::Matrix3d::Identity() - imu.normal * imu.normal.transpose());
  const KnownGround ground = known.of(stereo, false, imu);
  EXPECT_FALSE(ground.plane.valid());
  ASSERT_TRUE(ground.normal);
  EXPECT_TRUE(ground.normal->vector().isApprox(imu.normal, 1e-12));
  imu.failure = {Reason::kNotYet, "for the test"};
  EXPECT_FALSE(known.of(stereo, false, imu).normal);
}

}  // namespace
}  // namespace uav_landing
