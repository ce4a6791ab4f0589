#include "ros/autopilot_messages.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

using namespace uav_landing;

namespace {

constexpr double kDegree = M_PI / 180;
using Covariance = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

sensor_msgs::Range heightOf(double metres) {
  sensor_msgs::Range range;
  range.header.frame_id = "base_link";
  range.range = static_cast<float>(metres);
  return range;
}

/// An aircraft 100 m before the threshold, 3 m left of the centre line, 10 m high, well known.
geometry_msgs::PoseWithCovarianceStamped someWhere() {
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header.stamp = ros::Time(12.5);
  pose.header.frame_id = "runway";
  pose.pose.pose.position.x = -100;
  pose.pose.pose.position.y = 3;
  pose.pose.pose.position.z = 10;
  pose.pose.pose.orientation.w = 1;
  const double variances[6] = {4, 0.25, 0.01, 1e-6, 2e-6, 3e-6};
  for (int i = 0; i < 6; ++i) pose.pose.covariance[7 * i] = variances[i];
  return pose;
}

/// Turned about an axis of the aircraft (0: forward, 1: left, 2: up).
void turn(geometry_msgs::PoseWithCovarianceStamped& pose, int axis, double angle) {
  double parts[3] = {0, 0, 0};
  parts[axis] = std::sin(angle / 2);
  pose.pose.pose.orientation.x = parts[0];
  pose.pose.pose.orientation.y = parts[1];
  pose.pose.pose.orientation.z = parts[2];
  pose.pose.pose.orientation.w = std::cos(angle / 2);
}

TEST(AutopilotRange, IsTheHeightOfALevelAircraft) {
  const auto range = autopilotRange(heightOf(10), someWhere(), AutopilotParameters());
  ASSERT_TRUE(range);
  EXPECT_FLOAT_EQ(range->range, 10);
  EXPECT_FLOAT_EQ(range->max_range, 655);
  EXPECT_EQ(range->header.frame_id, "base_link");
}

TEST(AutopilotRange, SaysWhyThereIsNone) {
  const auto why = [](double height, double tilt) {
    auto pose = someWhere();
    turn(pose, 1, tilt);
    EXPECT_FALSE(autopilotRange(heightOf(height), pose, AutopilotParameters())) << height << ' ' << tilt;
    return whyNoRange(heightOf(height), pose, AutopilotParameters());
  };
  EXPECT_EQ(why(std::numeric_limits<double>::quiet_NaN(), 0), "no valid height");
  EXPECT_EQ(why(700, 0), "the surface is not within 0 to 655 m (max_range), at a height of 700 m");
  EXPECT_EQ(why(-1, 0), "the surface is not within 0 to 655 m (max_range), at a height of -1 m");
  EXPECT_EQ(
      why(10, 85 * kDegree),
      "what is estimated is tilted by 85 deg, as a camera is and no aircraft: base_frame or its static tf "
      "is missing");
  EXPECT_NE(why(10, M_PI).find("tilted by 180 deg"), std::string::npos) << why(10, M_PI);
}

TEST(AutopilotRange, IsLongerAlongTheAxisOfATiltedAircraft) {
  auto pose = someWhere();
  turn(pose, 0, 60 * kDegree - 1e-6);
  auto range = autopilotRange(heightOf(10), pose, AutopilotParameters());
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->range, 20, 1e-3) << "a right triangle with 60 degrees";
  turn(pose, 1, -30 * kDegree);
  range = autopilotRange(heightOf(10), pose, AutopilotParameters());
  ASSERT_TRUE(range);
  EXPECT_NEAR(range->range, 20 / std::sqrt(3), 1e-4);
}

TEST(AutopilotRange, IsSilentRatherThanWrong) {
  const AutopilotParameters parameters;
  EXPECT_FALSE(autopilotRange(heightOf(std::numeric_limits<double>::quiet_NaN()), someWhere(), parameters));
  EXPECT_FALSE(autopilotRange(heightOf(656), someWhere(), parameters)) << "would wrap in 16 bit";
  EXPECT_FALSE(autopilotRange(heightOf(-0.1), someWhere(), parameters));
  auto camera = someWhere();  // a camera's optical frame: z is forward
  turn(camera, 1, 90 * kDegree);
  EXPECT_FALSE(autopilotRange(heightOf(10), camera, parameters));
}

TEST(AutopilotPose, OfARunwayToTheEastIsAsItWas) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 90;
  const auto pose = autopilotPose(someWhere(), parameters);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->header.frame_id, "map");
  EXPECT_EQ(pose->header.stamp, ros::Time(12.5));
  EXPECT_NEAR(pose->pose.pose.position.x, -100, 1e-9);
  EXPECT_NEAR(pose->pose.pose.position.y, 3, 1e-9);
  EXPECT_NEAR(pose->pose.pose.position.z, 10, 1e-9);
  EXPECT_NEAR(pose->pose.pose.orientation.w, 1, 1e-12);
}

TEST(AutopilotPose, OfARunwayToTheSouthHasEastOnItsLeft) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 180;
  const auto pose = autopilotPose(someWhere(), parameters);
  ASSERT_TRUE(pose);
  // Landing southwards, 100 m before the threshold is 100 m north of it, and left is east.
  EXPECT_NEAR(pose->pose.pose.position.x, 3, 1e-9);
  EXPECT_NEAR(pose->pose.pose.position.y, 100, 1e-9);
  EXPECT_NEAR(pose->pose.pose.position.z, 10, 1e-9);
  // The nose points south: forward is -y.
  const auto& q = pose->pose.pose.orientation;
  const Eigen::Vector3d forward = Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((forward - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-9);
  // The variance along the runway is now that of north, and likewise of the rotations.
  EXPECT_NEAR(pose->pose.covariance[0], 0.25, 1e-9);
  EXPECT_NEAR(pose->pose.covariance[7], 4, 1e-9);
  EXPECT_NEAR(pose->pose.covariance[14], 0.01, 1e-9);
  EXPECT_NEAR(pose->pose.covariance[21], 2e-6, 1e-12);
  EXPECT_NEAR(pose->pose.covariance[28], 1e-6, 1e-12);
}

TEST(AutopilotPose, KeepsTheCorrelationsOfPositionAndRotation) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 0;  // to the north: runway x is y, runway y is -x
  auto given = someWhere();
  given.pose.covariance[4] = given.pose.covariance[24] = 1e-3;  // of x and the rotation about y
  const auto pose = autopilotPose(given, parameters);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->pose.covariance[6 * 1 + 3], -1e-3, 1e-12);
  EXPECT_NEAR(pose->pose.covariance[6 * 3 + 1], -1e-3, 1e-12);
  EXPECT_NEAR(pose->pose.covariance[6 * 0 + 4], 0, 1e-12);
}

TEST(AutopilotPose, IsSilentRatherThanWrong) {
  AutopilotParameters parameters;
  EXPECT_FALSE(autopilotPose(someWhere(), parameters)) << "of no heading";
  parameters.runway_heading_deg = 0;
  EXPECT_TRUE(autopilotPose(someWhere(), parameters));
  auto camera = someWhere();  // its optical frame: z is forward
  turn(camera, 1, 90 * kDegree);
  EXPECT_FALSE(autopilotPose(camera, parameters));
  auto unknown_place = someWhere();
  unknown_place.pose.covariance[0] = 1e6;
  EXPECT_FALSE(autopilotPose(unknown_place, parameters));
  auto indefinite = someWhere();
  indefinite.pose.covariance[14] = -1;
  EXPECT_FALSE(autopilotPose(indefinite, parameters));
  auto unfinished = someWhere();
  unfinished.pose.covariance[21] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(autopilotPose(unfinished, parameters));
  auto nowhere = someWhere();
  nowhere.pose.pose.position.z = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(autopilotPose(nowhere, parameters));
}

/// 20 m/s forward, 1 m/s down, turning left by 0.1 rad/s.
geometry_msgs::TwistWithCovarianceStamped someMovement() {
  geometry_msgs::TwistWithCovarianceStamped twist;
  twist.header.stamp = ros::Time(12.5);
  twist.header.frame_id = "base_link";
  twist.twist.twist.linear.x = 20;
  twist.twist.twist.linear.z = -1;
  twist.twist.twist.angular.z = 0.1;
  const double variances[6] = {0.04, 0.01, 0.02, 1e-6, 2e-6, 3e-6};
  for (int i = 0; i < 6; ++i) twist.twist.covariance[7 * i] = variances[i];
  return twist;
}

TEST(AutopilotVelocity, OfAnAircraftThatLandsSouthwardsPointsSouth) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 180;
  const auto velocity = autopilotVelocity(someMovement(), someWhere(), parameters);
  ASSERT_TRUE(velocity);
  EXPECT_EQ(velocity->header.frame_id, "map");
  EXPECT_EQ(velocity->header.stamp, ros::Time(12.5));
  EXPECT_NEAR(velocity->twist.twist.linear.x, 0, 1e-9);
  EXPECT_NEAR(velocity->twist.twist.linear.y, -20, 1e-9);
  EXPECT_NEAR(velocity->twist.twist.linear.z, -1, 1e-9);
  EXPECT_NEAR(velocity->twist.twist.angular.z, 0.1, 1e-9);
}

TEST(AutopilotVelocity, OfAnAircraftThatCrabsIsAlongItsPath) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 90;
  auto pose = someWhere();
  turn(pose, 2, 10 * kDegree);  // nose to the left, which is north
  const auto velocity = autopilotVelocity(someMovement(), pose, parameters);
  ASSERT_TRUE(velocity);
  EXPECT_NEAR(velocity->twist.twist.linear.x, 20 * std::cos(10 * kDegree), 1e-9);
  EXPECT_NEAR(velocity->twist.twist.linear.y, 20 * std::sin(10 * kDegree), 1e-9);
}

TEST(AutopilotVelocity, IsAsUncertainAcrossAsTheAttitudeTurnsIt) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 90;
  const auto velocity = autopilotVelocity(someMovement(), someWhere(), parameters);
  ASSERT_TRUE(velocity);
  // To the north by the yaw over 20 m/s and by the roll over 1 m/s; upwards by the pitch.
  EXPECT_NEAR(velocity->twist.covariance[0], 0.04 + 2e-6, 1e-9);
  EXPECT_NEAR(velocity->twist.covariance[7], 0.01 + 400 * 3e-6 + 1e-6, 1e-9);
  EXPECT_NEAR(velocity->twist.covariance[14], 0.02 + 400 * 2e-6, 1e-9);
  EXPECT_NEAR(velocity->twist.covariance[2], 20 * 2e-6, 1e-9) << "nose down by a pitch that is wrong";
}

TEST(AutopilotVelocity, HasItsCovarianceAlongEastAndNorth) {
  AutopilotParameters parameters;
  parameters.runway_heading_deg = 180;  // forward is south, left is east
  const auto south = autopilotVelocity(someMovement(), someWhere(), parameters);
  ASSERT_TRUE(south);
  // To the east what is across, by the yaw over 20 m/s and by the roll over 1 m/s; to the north what is
  // along.
  EXPECT_NEAR(south->twist.covariance[0], 0.01 + 400 * 3e-6 + 1e-6, 1e-9);
  EXPECT_NEAR(south->twist.covariance[7], 0.04 + 2e-6, 1e-9);
  EXPECT_NEAR(south->twist.covariance[14], 0.02 + 400 * 2e-6, 1e-9);
  EXPECT_NEAR(south->twist.covariance[6 * 1 + 2], -20 * 2e-6, 1e-9) << "forward is -y";
  // The rotations' own, and what the attitude makes of 0.1 rad/s about the up axis: about east the pitch's
  // was the roll's.
  EXPECT_NEAR(south->twist.covariance[21], 2e-6 + 0.01 * 1e-6, 1e-12);
  EXPECT_NEAR(south->twist.covariance[28], 1e-6 + 0.01 * 2e-6, 1e-12);
  EXPECT_NEAR(south->twist.covariance[35], 3e-6, 1e-12);
  // Half way between: 0.04 along and 0.01 across are alike to both, and go together.
  parameters.runway_heading_deg = 45;
  auto certain = someWhere();
  for (int i = 3; i < 6; ++i) certain.pose.covariance[7 * i] = 1e-12;
  const auto north_east = autopilotVelocity(someMovement(), certain, parameters);
  ASSERT_TRUE(north_east);
  EXPECT_NEAR(north_east->twist.covariance[0], 0.025, 1e-8);
  EXPECT_NEAR(north_east->twist.covariance[7], 0.025, 1e-8);
  EXPECT_NEAR(north_east->twist.covariance[1], 0.015, 1e-8);
}

TEST(AutopilotVelocity, IsSilentRatherThanWrong) {
  AutopilotParameters parameters;
  EXPECT_FALSE(autopilotVelocity(someMovement(), someWhere(), parameters)) << "of no heading";
  parameters.runway_heading_deg = 0;
  auto unknown_place = someWhere();
  unknown_place.pose.covariance[0] = 1e6;
  EXPECT_TRUE(autopilotVelocity(someMovement(), unknown_place, parameters)) << "it needs none";
  auto unknown_yaw = someWhere();
  unknown_yaw.pose.covariance[35] = M_PI * M_PI;
  EXPECT_FALSE(autopilotVelocity(someMovement(), unknown_yaw, parameters));
  EXPECT_EQ(whyNoVelocity(unknown_yaw), "the runway's direction is not seen");
  auto camera = someWhere();
  turn(camera, 1, 90 * kDegree);
  EXPECT_FALSE(autopilotVelocity(someMovement(), camera, parameters));
  EXPECT_EQ(whyNoVelocity(camera), "the attitude is not that of an aircraft");
  auto indefinite = someMovement();
  indefinite.twist.covariance[7] = -1;
  EXPECT_FALSE(autopilotVelocity(indefinite, someWhere(), parameters));
  EXPECT_EQ(whyNoVelocity(someWhere()), "it has no definite covariance");
  auto unfinished = someMovement();
  unfinished.twist.twist.angular.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(autopilotVelocity(unfinished, someWhere(), parameters));
}

}  // namespace
