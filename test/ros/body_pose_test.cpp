#include "body_pose.h"

#include <gtest/gtest.h>

#include <cmath>

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
    camera_.vertical_speed = -1;
    camera_.vertical_speed_variance = 0.04;
    step_.duration = 0.1;
    step_.rotation.setZero();
    step_.covariance.setZero();
  }
  LandingResult camera_;
  ApproachAngleResult::Motion step_;
};

TEST_F(ReferToTest, APointBehindACameraThatLooksDownIsHigher) {
  const LandingResult body = referTo({0, 0, -2}, camera_, step_);
  EXPECT_NEAR(body.height, 11, 1e-12) << "2 m sin 30 degrees";
  EXPECT_NEAR(body.raw_height, 11, 1e-12);
  EXPECT_NEAR(body.points_height, 11, 1e-12);
  EXPECT_NEAR(body.vertical_speed, -1, 1e-12) << "no rotation";
  EXPECT_TRUE(body.height_valid);
}

TEST_F(ReferToTest, UncertainPitchMakesTheHeightOfAPointBehindUncertain) {
  camera_.pitch_variance = 1e-4;
  // The point moves by 2 m cos 30 degrees per radian.
  EXPECT_NEAR(referTo({0, 0, -2}, camera_, step_).height_variance, 0.01 + 3 * 1e-4, 1e-12);
}

TEST_F(ReferToTest, UncertainRollMattersForAPointToTheSide) {
  camera_.roll_variance = 1e-4;
  EXPECT_NEAR(referTo({1, 0, 0}, camera_, step_).height_variance, 0.01 + 0.75 * 1e-4, 1e-12);
  EXPECT_NEAR(referTo({0, 0, -2}, camera_, step_).height_variance, 0.01, 1e-12);
}

TEST_F(ReferToTest, NoseUpRotationLowersThePointBehind) {
  camera_ = attitude(0, 0, 0);
  camera_.vertical_speed = 0;
  camera_.vertical_speed_variance = 0;
  // The camera turns up by 0.01 rad in 0.1 s: what it sees moves down (+y). x_now = R x_then with R about x
  // by -0.01 takes forward (z) towards +y.
  step_.rotation = {-0.01, 0, 0};
  EXPECT_NEAR(referTo({0, 0, -2}, camera_, step_).vertical_speed, -2 * 0.1, 1e-3);
}

TEST_F(ReferToTest, WithoutTheRotationTheVerticalSpeedIsUnknown) {
  step_ = {};
  EXPECT_TRUE(std::isnan(referTo({0, 0, -2}, camera_, step_).vertical_speed));
  EXPECT_NEAR(referTo({0, 0, -2}, camera_, step_).height, 11, 1e-12);
}

TEST_F(ReferToTest, WithoutAnAttitudeTheHeightIsNotValid) {
  camera_.pitch = camera_.roll = kUnknown;
  const LandingResult body = referTo({0, 0, -2}, camera_, step_);
  EXPECT_FALSE(body.height_valid);
  EXPECT_TRUE(std::isnan(body.height));
  EXPECT_EQ(body.failure.reason, Reason::kNoGroundNormal);
}

}  // namespace
