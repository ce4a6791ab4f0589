#include "body_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pose_covariance.h"

using namespace uav_landing;

namespace {

constexpr double kDegree = M_PI / 180;

LandingResult attitude(double pitch_deg, double roll_deg, double yaw_deg) {
  LandingResult result;
  result.pitch = pitch_deg * kDegree;
  result.roll = roll_deg * kDegree;
  result.yaw = yaw_deg * kDegree;
  result.pitch_variance = result.roll_variance = 0;
  return result;
}

void expectNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { EXPECT_NEAR((a - b).norm(), 0, 1e-12); }

TEST(RunwayFromCamera, LevelCameraLooksAlongTheRunway) {
  const Eigen::Matrix3d R = runwayFromCamera(attitude(0, 0, 0));
  expectNear(R * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
  expectNear(R * Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY());
  expectNear(R * Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ());
}

TEST(RunwayFromCamera, PositivePitchLooksUp) {
  expectNear(runwayFromCamera(attitude(30, 0, 0)) * Eigen::Vector3d::UnitZ(),
             {std::cos(30 * kDegree), 0, std::sin(30 * kDegree)});
}

TEST(RunwayFromCamera, PositiveRollHasTheRightSideDown) {
  EXPECT_NEAR((runwayFromCamera(attitude(0, 20, 0)) * Eigen::Vector3d::UnitX()).z(), -std::sin(20 * kDegree),
              1e-12);
}

TEST(RunwayFromCamera, PositiveYawLooksToTheLeft) {
  expectNear(runwayFromCamera(attitude(0, 0, 10)) * Eigen::Vector3d::UnitZ(),
             {std::cos(10 * kDegree), std::sin(10 * kDegree), 0});
}

TEST(RunwayFromCamera, TheGroundNormalPointsDownWhateverTheAttitude) {
  const LandingResult camera = attitude(-12, 8, 25);
  expectNear(runwayFromCamera(camera) * normalFromPitchRoll(camera.pitch, camera.roll),
             -Eigen::Vector3d::UnitZ());
}

TEST(RunwayFromCamera, AnUnknownYawCountsAsZero) {
  LandingResult camera = attitude(0, 0, 0);
  camera.yaw = kUnknown;
  expectNear(runwayFromCamera(camera) * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
}

class ReferToTest : public testing::Test {
 protected:
  ReferToTest() : camera_(attitude(-30, 0, 0)) {
    camera_.height_valid = true;
    camera_.height = camera_.raw_height = camera_.points_height = 10;
    camera_.height_variance = camera_.raw_height_variance = 0.01;
    camera_.height_above_runway = 8;
    camera_.height_above_runway_variance = 4;
    camera_.vertical_speed = -1;
    camera_.vertical_speed_variance = 0.04;
    step_.duration = 0.1;
    step_.rotation.setZero();
    step_.covariance.setZero();
  }
  LandingResult refer(const Eigen::Vector3d& point) const {
    return referTo(point, camera_, plane_, step_, parameters_);
  }

  LandingResult camera_;
  GroundPlane plane_;  // none: height and attitude err independently
  ApproachAngleResult::Motion step_;
  KalmanHeightParameters parameters_;
};

TEST_F(ReferToTest, APointBehindACameraThatLooksDownIsHigher) {
  const LandingResult body = refer({0, 0, -2});
  EXPECT_NEAR(body.height, 11, 1e-12) << "2 m sin 30 degrees";
  EXPECT_NEAR(body.raw_height, 11, 1e-12);
  EXPECT_NEAR(body.points_height, 11, 1e-12);
  EXPECT_NEAR(body.height_above_runway, 9, 1e-12);
  EXPECT_NEAR(body.vertical_speed, -1, 1e-12) << "no rotation";
  EXPECT_TRUE(body.height_valid);
}

TEST_F(ReferToTest, UncertainPitchMakesTheHeightOfAPointBehindUncertain) {
  camera_.pitch_variance = 1e-4;
  // The point moves by 2 m cos 30 degrees per radian.
  EXPECT_NEAR(refer({0, 0, -2}).height_variance, 0.01 + 3 * 1e-4, 1e-12);
  EXPECT_NEAR(refer({0, 0, -2}).height_above_runway_variance, 4 + 3 * 1e-4, 1e-12);
}

TEST_F(ReferToTest, UncertainRollMattersForAPointToTheSide) {
  camera_.roll_variance = 1e-4;
  EXPECT_NEAR(refer({1, 0, 0}).height_variance, 0.01 + 0.75 * 1e-4, 1e-12);
  EXPECT_NEAR(refer({0, 0, -2}).height_variance, 0.01, 1e-12);
}

TEST_F(ReferToTest, HeightAndAttitudeOfOnePlaneErrTogether) {
  // Both by an error of the plane's slope ahead: nose too high by de means a height too large by 20 m de.
  camera_ = attitude(0, 0, 0);
  camera_.height = camera_.raw_height = 10;
  camera_.height_valid = true;
  const double slope_variance = 1e-6, by_slope = 20;
  plane_.g = Eigen::Vector3d(0, 0.1, 0);
  // g = n / h: dg = (0, -dh / h^2, -dpitch / h).
  const Eigen::Vector3d by(0, -by_slope / 100, -0.1);
  plane_.covariance = slope_variance * by * by.transpose() + 1e-12 * Eigen::Matrix3d::Identity();
  camera_.pitch_variance = slope_variance;
  camera_.height_variance = camera_.raw_height_variance = by_slope * by_slope * slope_variance;
  // The point behind comes down by 2 m a radian where the camera comes up by 20 m.
  EXPECT_NEAR(refer({0, 0, -2}).height_variance, 18 * 18 * slope_variance, 2e-7);
  EXPECT_NEAR(refer({0, 0, 2}).height_variance, 22 * 22 * slope_variance, 2e-7);
  EXPECT_NEAR(refer({0, 0, 2}).raw_height_variance, 22 * 22 * slope_variance, 2e-7);
}

TEST_F(ReferToTest, ItsHeightVarianceIsThatOfThePose) {
  camera_ = attitude(-7, 11, 25);
  camera_.height = camera_.raw_height = 4;
  camera_.height_variance = 4e-4;
  camera_.pitch_variance = 3e-6;
  camera_.roll_variance = 5e-6;
  camera_.yaw_variance = 1e-5;
  plane_.g = normalFromPitchRoll(camera_.pitch, camera_.roll) / camera_.height;
  Eigen::Matrix3d root;
  root << 2e-4, 1e-4, 0, -1e-4, 5e-4, 2e-4, 3e-4, 0, 4e-4;
  plane_.covariance = root * root.transpose();
  const Eigen::Vector3d point(0.4, -0.3, -2.5);
  EXPECT_NEAR(refer(point).height_variance, poseCovariance(camera_, plane_, point, {1, 1})(2, 2), 1e-15);
}

TEST_F(ReferToTest, TheProtectionLevelHoldsForThePoint) {
  camera_.pitch_variance = 1e-4;
  camera_.height_protection_level = 0.5;
  camera_.height_alert_limit = 0.6;
  parameters_.integrity_risk = 1 - std::erf(5 / std::sqrt(2.0));
  // 5 sigma of 2 m cos 30 degrees times 0.01 rad.
  const LandingResult body = refer({0, 0, -2});
  EXPECT_NEAR(body.height_protection_level, 0.5 + 5 * std::sqrt(3.0) * 0.01, 1e-9);
  EXPECT_TRUE(body.height_valid);
  camera_.height_alert_limit = 0.55;
  const LandingResult beyond = refer({0, 0, -2});
  EXPECT_FALSE(beyond.height_valid);
  EXPECT_EQ(beyond.failure.reason, Reason::kUncertain);
  EXPECT_NE(beyond.failure.message().find("the lever arm adds 0.0866"), std::string::npos)
      << beyond.failure.message();
}

TEST_F(ReferToTest, APointThatSwingsTooFarHasNoValidHeight) {
  camera_.pitch_variance = 4e-4;
  camera_.height_protection_level = 0.5;
  camera_.height_alert_limit = 10;
  camera_.velocity = {0, 0, 20};
  EXPECT_TRUE(refer({0, 0, -5}).height_valid) << "3 sigma 0.4 m of 0.6 m";
  EXPECT_EQ(refer({0, 0, -5}).velocity, camera_.velocity);
  const LandingResult body = refer({0, 0, -30});
  EXPECT_FALSE(body.height_valid);
  EXPECT_TRUE(body.velocity.array().isNaN().all());
  EXPECT_EQ(body.failure.reason, Reason::kUncertain);
  EXPECT_NE(body.failure.message().find("3 sigma of"), std::string::npos) << body.failure.message();
}

TEST_F(ReferToTest, NoseUpRotationLowersThePointBehind) {
  camera_ = attitude(0, 0, 0);
  camera_.vertical_speed = 0;
  camera_.vertical_speed_variance = 0;
  // The camera turns up by 0.01 rad in 0.1 s: what it sees moves down (+y). x_now = R x_then with R about x
  // by -0.01 takes forward (z) towards +y.
  step_.rotation = {-0.01, 0, 0};
  EXPECT_NEAR(refer({0, 0, -2}).vertical_speed, -2 * 0.1, 1e-3);
}

TEST_F(ReferToTest, ThePositionIsThatOfThePoint) {
  camera_ = attitude(0, 0, 0);
  camera_.x = -100;
  camera_.x_variance = 0.5;
  camera_.y = 3;
  camera_.y_variance = 0.25;
  const Eigen::Vector3d one_right_two_behind(1, 0, -2);
  LandingResult body = refer(one_right_two_behind);
  EXPECT_NEAR(body.x, -102, 1e-12);
  EXPECT_NEAR(body.y, 2, 1e-12);
  EXPECT_NEAR(body.x_variance, 0.5, 1e-12) << "nothing is known of the yaw";
  EXPECT_NEAR(body.y_variance, 0.25, 1e-12);
  camera_.yaw = 90 * kDegree;  // looks to the left: right is ahead, behind is to the right
  body = refer(one_right_two_behind);
  EXPECT_NEAR(body.x, -99, 1e-12);
  EXPECT_NEAR(body.y, 1, 1e-12);
}

TEST_F(ReferToTest, AnUncertainYawSwingsThePointAcross) {
  camera_ = attitude(0, 0, 0);
  camera_.x = -100;
  camera_.x_variance = 0.5;
  camera_.y = 3;
  camera_.y_variance = 0.25;
  camera_.y_protection_level = 2;
  camera_.yaw_variance = 1e-4;
  const LandingResult body = refer({1, 0, -2});
  // By a radian it swings 1 m along the runway, which it is to the right, and 2 m across, which it is behind.
  EXPECT_NEAR(body.x_variance, 0.5 + 1e-4, 1e-12);
  EXPECT_NEAR(body.y_variance, 0.25 + 4e-4, 1e-12);
  // With a risk of 1e-5 the yaw is within 4.417 sigma.
  EXPECT_NEAR(body.y_protection_level, 2 + 4.417 * 0.02, 1e-4);
}

TEST_F(ReferToTest, AnUncertainRotationOfTheStepMakesTheVerticalSpeedUncertain) {
  camera_ = attitude(0, 0, 0);
  camera_.vertical_speed = -1;
  camera_.vertical_speed_variance = 0.04;
  // In 0.1 s. Only the rotation about the axis to the right moves what is 2 m behind up and down.
  step_.covariance.diagonal() << 4e-6, 9e-6, 16e-6, 1, 1, 1;
  EXPECT_NEAR(refer({0, 0, -2}).vertical_speed_variance, 0.04 + 20 * 20 * 4e-6, 1e-12);
  // What is 1 m to the right moves by a rotation about the axis ahead.
  EXPECT_NEAR(refer({1, 0, 0}).vertical_speed_variance, 0.04 + 10 * 10 * 16e-6, 1e-12);
  step_.covariance(0, 2) = step_.covariance(2, 0) = 1e-6;
  EXPECT_NEAR(refer({1, 0, -2}).vertical_speed_variance,
              0.04 + 20 * 20 * 4e-6 + 10 * 10 * 16e-6 + 2 * 20 * 10 * 1e-6, 1e-12);
}

TEST_F(ReferToTest, RawHeightAndRunwayKeepTheirOwnVariances) {
  camera_.raw_height_variance = 0.09;
  camera_.pitch_variance = 1e-4;
  const LandingResult body = refer({0, 0, -2});
  EXPECT_NEAR(body.height_variance, 0.01 + 3e-4, 1e-12);
  EXPECT_NEAR(body.raw_height_variance, 0.09 + 3e-4, 1e-12);
  EXPECT_NEAR(body.height_above_runway_variance, 4 + 3e-4, 1e-12);
}

TEST_F(ReferToTest, WithoutTheRotationTheVerticalSpeedIsUnknown) {
  step_ = {};
  EXPECT_TRUE(std::isnan(refer({0, 0, -2}).vertical_speed));
  EXPECT_NEAR(refer({0, 0, -2}).height, 11, 1e-12);
}

TEST_F(ReferToTest, WithoutAnAttitudeTheHeightIsNotValid) {
  camera_.pitch = camera_.roll = kUnknown;
  const LandingResult body = refer({0, 0, -2});
  EXPECT_FALSE(body.height_valid);
  EXPECT_TRUE(std::isnan(body.height));
  EXPECT_EQ(body.failure.reason, Reason::kNoGroundNormal);
}

}  // namespace
