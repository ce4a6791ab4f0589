#include "far/disparity_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180, kCalibrated = 0.02, kHeight = 40;  // px, m

StereoRig rig() {
  StereoRig result;
  result.size = {640, 480};
  result.fx = result.fy = 554;
  result.baseline = 1;
  return result;
}

/// Pairs of a flight over level ground, 10 a second.
class Flight {
 public:
  explicit Flight(double bias, double noise = 0.01) : bias_(bias), noise_(noise) {}

  /// What is known after so many pairs.
  const DisparityBias& fly(int pairs, bool motion_known = true) {
    for (int i = 0; i < pairs; ++i) {
      known.predict(0.1 * count_, kCalibrated);
      const double pitch = -3 * kDegree + 0.5 * kDegree * std::sin(0.3 * count_++);
      // A bias of all disparities d = f b g.r is one of g_z.
      plane.g = normalFromPitchRoll(pitch, 0) / kHeight;
      plane.g.z() += (bias_ + noise_ * normal_(random_)) / rig().fb();
      plane.covariance = Eigen::Matrix3d::Zero();
      plane.covariance(2, 2) = (kCalibrated * kCalibrated + noise_ * noise_) / (rig().fb() * rig().fb());
      ApproachAngleResult::Motion motion;
      motion.normal = normalFromPitchRoll(pitch, 0);
      motion.normal_covariance = std::pow(0.02 * kDegree, 2) * Eigen::Matrix3d::Identity();
      if (!motion_known) motion.failure = {Reason::kNotYet, "for the test"};
      known.update(plane, motion);
    }
    return known;
  }

  DisparityBias known{rig()};
  GroundPlane plane;

 private:
  double bias_, noise_;
  int count_ = 0;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

TEST(DisparityBias, IsToldByTheNormalOfTheMotion) {
  for (const double bias : {-0.03, 0.0, 0.02, 0.1}) {
    Flight flight(bias);
    const DisparityBias& known = flight.fly(60);
    EXPECT_NEAR(known.value(), bias, 0.01);
    EXPECT_LT(known.variance(), 0.25 * kCalibrated * kCalibrated);
    EXPECT_GT(known.variance(), 0.003 * 0.003) << "errors are alike in many pairs";
  }
}

TEST(DisparityBias, IsTheCalibrationsAsLongAsNothingIsSeen) {
  Flight flight(0.1);
  const DisparityBias& known = flight.fly(20, false);
  EXPECT_EQ(known.value(), 0);
  EXPECT_DOUBLE_EQ(known.variance(), kCalibrated * kCalibrated);
}

TEST(DisparityBias, IsTakenOutOfThePlane) {
  Flight flight(0.06, 0);
  const DisparityBias& known = flight.fly(100);
  const GroundPlane corrected = known.corrected(flight.plane);
  const double off = rig().fb() * (flight.plane.g.z() - corrected.g.z());
  EXPECT_NEAR(off, 0.06, 0.005);
  EXPECT_LT(corrected.covariance(2, 2), 0.25 * flight.plane.covariance(2, 2));
  EXPECT_GT(corrected.covariance(2, 2), 0);
}

TEST(DisparityBias, ATimeJumpForgetsIt) {
  Flight flight(0.06);
  flight.fly(60);
  flight.known.predict(-5, kCalibrated);
  EXPECT_EQ(flight.known.value(), 0);
  EXPECT_DOUBLE_EQ(flight.known.variance(), kCalibrated * kCalibrated);
}

TEST(DisparityBias, AnExactCalibrationHasNone) {
  DisparityBias known(rig());
  known.predict(0, 0);
  GroundPlane plane;
  plane.g = Eigen::Vector3d(0, 1, 0.001) / kHeight;
  plane.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  ApproachAngleResult::Motion motion;
  motion.normal = {0, 1, 0};
  motion.normal_covariance = 1e-8 * Eigen::Matrix3d::Identity();
  known.update(plane, motion);
  EXPECT_EQ(known.value(), 0);
  EXPECT_EQ(known.variance(), 0);
  EXPECT_EQ(known.corrected(plane).g, plane.g);
}

}  // namespace
}  // namespace uav_landing
