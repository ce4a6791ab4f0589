#include "imu_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::Imu level(double stamp) {
  sensor_msgs::Imu message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = "imu_link";
  message.orientation.w = 1;
  return message;
}

/// Optical axes (x right, y down, z forward) in a parent whose axes are forward, left, up.
tf2_msgs::TFMessage opticalFrame(const std::string& parent, const std::string& child) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.rotation.x = -0.5;
  message.transforms[0].transform.rotation.y = 0.5;
  message.transforms[0].transform.rotation.z = -0.5;
  message.transforms[0].transform.rotation.w = 0.5;
  return message;
}

void fill(ImuInput& input, const std::function<sensor_msgs::Imu(double)>& make) {
  for (int i = 0; i <= 100; ++i) EXPECT_EQ(input.add(make(100 + 0.01 * i)).message(), "");
}

TEST(ImuReading, MinusOneInFrontOfACovarianceMeansThatThereIsNoSuchField) {
  sensor_msgs::Imu message = level(1);
  message.orientation_covariance[0] = -1;
  ImuReading reading = toReading(message);
  EXPECT_FALSE(reading.sample.orientation);
  EXPECT_TRUE(reading.sample.angular_velocity);
  EXPECT_FALSE(reading.failure);
  message.angular_velocity_covariance[0] = -1;
  reading = toReading(message);
  EXPECT_FALSE(reading.usable());
  EXPECT_EQ(reading.failure.message(), "input_invalid: neither an orientation nor an angular velocity");
}

TEST(ImuReading, CovariancesThatAreNoneAreNotKnown) {
  sensor_msgs::Imu message = level(1);
  EXPECT_FALSE(toReading(message).sample.orientation_covariance) << "zeros";
  message.orientation_covariance = {0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.3};
  ASSERT_TRUE(toReading(message).sample.orientation_covariance);
  EXPECT_EQ((*toReading(message).sample.orientation_covariance)(1, 1), 0.2);
  for (const double bad : {0.0, -0.1, kNaN}) {
    message.orientation_covariance[4] = bad;
    const ImuReading reading = toReading(message);
    EXPECT_TRUE(reading.sample.orientation) << bad;
    EXPECT_FALSE(reading.sample.orientation_covariance) << bad;
  }
  message.orientation_covariance = {0.1, 0.5, 0, 0.5, 0.1, 0, 0, 0, 0.3};
  EXPECT_FALSE(toReading(message).sample.orientation_covariance) << "not positive definite";
}

TEST(ImuReading, EachFieldOfTheMessageGoesToItsOwnPlace) {
  sensor_msgs::Imu message = level(12.5);
  message.orientation.x = 0.1;
  message.orientation.y = 0.3;
  message.orientation.z = 0.5;
  message.orientation.w = std::sqrt(1 - 0.01 - 0.09 - 0.25);
  message.angular_velocity.x = 0.2;
  message.angular_velocity.y = 0.4;
  message.angular_velocity.z = 0.6;
  message.linear_acceleration.x = 7;
  message.orientation_covariance = {0.1, 0.01, 0.02, 0.01, 0.2, 0.03, 0.02, 0.03, 0.3};
  message.angular_velocity_covariance = {1.1, 0.11, 0.12, 0.11, 1.2, 0.13, 0.12, 0.13, 1.3};
  message.linear_acceleration_covariance = {9, 0, 0, 0, 9, 0, 0, 0, 9};
  const ImuReading reading = toReading(message);
  EXPECT_FALSE(reading.failure) << reading.failure.message();
  EXPECT_EQ(reading.sample.stamp, 12.5);
  ASSERT_TRUE(reading.sample.orientation && reading.sample.orientation_covariance);
  EXPECT_TRUE(reading.sample.orientation->vec().isApprox(Eigen::Vector3d(0.1, 0.3, 0.5), 1e-12));
  EXPECT_NEAR(reading.sample.orientation->w(), message.orientation.w, 1e-12);
  Eigen::Matrix3d expected;
  expected << 0.1, 0.01, 0.02, 0.01, 0.2, 0.03, 0.02, 0.03, 0.3;
  EXPECT_TRUE(reading.sample.orientation_covariance->isApprox(expected, 1e-12));
  ASSERT_TRUE(reading.sample.angular_velocity && reading.sample.angular_velocity_covariance);
  EXPECT_EQ(*reading.sample.angular_velocity, Eigen::Vector3d(0.2, 0.4, 0.6));
  expected << 1.1, 0.11, 0.12, 0.11, 1.2, 0.13, 0.12, 0.13, 1.3;
  EXPECT_TRUE(reading.sample.angular_velocity_covariance->isApprox(expected, 1e-12));
}

TEST(ImuReading, WhatIsNoNumberIsLeftOutAndNamed) {
  sensor_msgs::Imu message = level(1);
  message.orientation.x = kNaN;
  ImuReading reading = toReading(message);
  EXPECT_FALSE(reading.sample.orientation);
  EXPECT_TRUE(reading.sample.angular_velocity);
  EXPECT_NE(reading.failure.message().find("orientation: expected a unit quaternion"), std::string::npos);
  message = level(1);
  message.orientation.w = 0;
  EXPECT_FALSE(toReading(message).sample.orientation) << "never filled in";
  message = level(1);
  message.angular_velocity.y = std::numeric_limits<double>::infinity();
  reading = toReading(message);
  EXPECT_TRUE(reading.sample.orientation);
  EXPECT_FALSE(reading.sample.angular_velocity);
  EXPECT_NE(reading.failure.message().find("angular_velocity: expected at most 100 rad/s, got 0, inf, 0"),
            std::string::npos);
}

TEST(ImuInput, TurnsIntoTheRectifiedCamera) {
  ImuInput input{ApproachAngleParameters()};
  input.addTransforms(opticalFrame("base_link", "left"));
  tf2_msgs::TFMessage mounting;
  mounting.transforms.resize(1);
  mounting.transforms[0].header.frame_id = "base_link";
  mounting.transforms[0].child_frame_id = "imu_link";
  // The sensor is mounted upside down.
  mounting.transforms[0].transform.rotation.x = 1;
  input.addTransforms(mounting);
  // The aircraft is nose down by 0.1, and turns left at 0.2 rad/s: its up axis is the sensor's down axis.
  fill(input, [](double stamp) {
    sensor_msgs::Imu message = level(stamp);
    const Eigen::Quaterniond body(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
    const Eigen::Quaterniond sensor = body * Eigen::Quaterniond(0, 1, 0, 0);
    message.orientation.x = sensor.x();
    message.orientation.y = sensor.y();
    message.orientation.z = sensor.z();
    message.orientation.w = sensor.w();
    message.angular_velocity.z = -0.2;
    return message;
  });
  // The rectified camera looks a little further up than the camera as it is mounted.
  const double up = 0.03;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(-up, Eigen::Vector3d::UnitX()).toRotationMatrix();
  input.at(ros::Time(100.4), "left", R);
  const AttitudePrior prior = input.at(ros::Time(100.5), "left", R);
  ASSERT_TRUE(prior.hasNormal()) << prior.failure.message();
  EXPECT_NEAR(pitchOf(prior.normal), -0.1 + up, 1e-9);
  EXPECT_NEAR(rollOf(prior.normal), 0, 1e-9);
  ASSERT_TRUE(prior.hasRotation());
  EXPECT_NEAR(prior.duration, 0.1, 1e-6);
  // A left turn carries what is at rest to the right: about the camera's down axis.
  EXPECT_NEAR(prior.rotation.norm(), 0.02, 1e-7);
  EXPECT_GT(prior.rotation.y(), 0.99 * 0.02);
}

TEST(ImuInput, SaysWhichFrameIsMissing) {
  ImuInput input{ApproachAngleParameters()};
  EXPECT_EQ(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).failure.message(),
            "not_yet: no imu message");
  fill(input, level);
  EXPECT_EQ(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).failure.message(),
            "transform_missing: no static transform between the imu's imu_link and left");
  EXPECT_EQ(input.at(ros::Time(100.5), "", Eigen::Matrix3d::Identity()).failure.message(),
            "transform_missing: the frame_id of the left camera_info is empty");
  input.addMovingTransforms(opticalFrame("imu_link", "left"));
  EXPECT_EQ(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).failure.message(),
            "transform_missing: imu_link -> left is on /tf, only /tf_static is used for the rig");
  input.addTransforms(opticalFrame("imu_link", "left"));
  EXPECT_EQ(input.at(ros::Time(100.6), "left", Eigen::Matrix3d::Identity()).failure.message(), "");
  sensor_msgs::Imu nameless = level(103);
  nameless.header.frame_id = "";
  input.add(nameless);
  EXPECT_EQ(input.at(ros::Time(100.7), "left", Eigen::Matrix3d::Identity()).failure.message(),
            "transform_missing: the imu messages have an empty frame_id");
}

TEST(ImuReading, NumbersThatOverflowFurtherOnAreNotTaken) {
  sensor_msgs::Imu message = level(1);
  message.angular_velocity.z = 1e200;
  message.orientation_covariance = {1e300, 0, 0, 0, 1, 0, 0, 0, 1};
  const ImuReading reading = toReading(message);
  EXPECT_FALSE(reading.sample.angular_velocity);
  ASSERT_TRUE(reading.sample.orientation);
  EXPECT_FALSE(reading.sample.orientation_covariance);
}

TEST(ImuInput, AnotherSensorOnTheTopicIsNamedAndDoesNotSilenceTheFirst) {
  ImuInput input{ApproachAngleParameters()};
  input.addTransforms(opticalFrame("imu_link", "left"));
  sensor_msgs::Imu foreign = level(0);
  foreign.header.frame_id = "head";
  for (int i = 0; i <= 100; ++i) {
    EXPECT_EQ(input.add(level(100 + 0.01 * i)).message(), "");
    if (i == 0) continue;
    foreign.header.stamp = ros::Time(100 + 0.01 * i);
    EXPECT_EQ(input.add(foreign).message(),
              "input_invalid: frame_id: 'head' after 'imu_link': are there two sensors on this topic?");
  }
  EXPECT_TRUE(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).hasNormal());
  // Once the first one is silent, it is the sensor.
  foreign.header.stamp = ros::Time(102.5);
  EXPECT_EQ(input.add(foreign).message(), "");
  EXPECT_EQ(input.at(ros::Time(102.5), "left", Eigen::Matrix3d::Identity()).failure.reason,
            Reason::kTransformMissing);
}

TEST(ImuInput, AStampAtTheEndOfTimeCostsNoMoreThanTheMessagesBeforeIt) {
  ImuInput input{ApproachAngleParameters()};
  input.addTransforms(opticalFrame("imu_link", "left"));
  fill(input, level);
  sensor_msgs::Imu last = level(0);
  last.header.stamp = ros::TIME_MAX;
  input.add(last);
  EXPECT_FALSE(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).hasNormal());
  fill(input, level);
  EXPECT_TRUE(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).hasNormal());
}

TEST(ImuInput, ALoopInTfIsAMissingTransform) {
  ImuInput input{ApproachAngleParameters()};
  input.addTransforms(opticalFrame("a", "left"));
  input.addTransforms(opticalFrame("b", "a"));
  input.addTransforms(opticalFrame("left", "b"));
  fill(input, level);
  EXPECT_EQ(input.at(ros::Time(100.5), "left", Eigen::Matrix3d::Identity()).failure.reason,
            Reason::kTransformMissing);
}

}  // namespace
}  // namespace uav_landing
