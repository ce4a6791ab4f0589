#include <cmath>

#include "fuzz/harnesses.h"
#include "fuzz/input.h"
#include "imu_input.h"

namespace uav_landing {
namespace fuzz {
namespace {

constexpr double kStart = 100, kStep = 0.01;  // s

ros::Time anyStamp(Input& input, double usual) {
  if (input.byte() < 220) return ros::Time(usual + 0.001 * (input.byte() - 128));
  return ros::Time(input.take<uint32_t>(), input.take<uint32_t>() % 1000000000);
}

sensor_msgs::Imu anyMessage(Input& input, double stamp) {
  sensor_msgs::Imu message;
  message.header.stamp = anyStamp(input, stamp);
  message.header.frame_id = input.byte() < 240 ? "imu_link" : input.text();
  message.orientation.w = input.number(1);
  message.orientation.x = input.number(0);
  message.orientation.y = input.number(0);
  message.orientation.z = input.number(0);
  message.angular_velocity.x = input.number(0.1);
  message.angular_velocity.y = input.number(-0.2);
  message.angular_velocity.z = input.number(0.05);
  const bool known = input.byte() < 128;
  for (size_t i = 0; i < 9; ++i) {
    message.orientation_covariance[i] = input.number(known && i % 4 == 0 ? 1e-4 : 0);
    message.angular_velocity_covariance[i] = input.number(known && i % 4 == 0 ? 1e-6 : 0);
  }
  return message;
}

tf2_msgs::TFMessage anyTransform(Input& input) {
  const char* const names[] = {"imu_link", "base_link", "left", "mount"};
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = input.byte() < 240 ? names[input.choice(4)] : input.text();
  transform.child_frame_id = input.byte() < 240 ? names[input.choice(4)] : input.text();
  transform.transform.translation.x = input.number(0.1);
  transform.transform.translation.y = input.number(0);
  transform.transform.translation.z = input.number(-0.3);
  transform.transform.rotation.x = input.number(-0.5);
  transform.transform.rotation.y = input.number(0.5);
  transform.transform.rotation.z = input.number(-0.5);
  transform.transform.rotation.w = input.number(0.5);
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  return message;
}

void expectHonest(const AttitudePrior& prior) {
  if (prior.hasNormal()) {
    require(std::abs(prior.normal.norm() - 1) < 1e-6, "the direction of gravity has unit length");
    require(prior.normal_covariance.diagonal().minCoeff() > -1e-12, "its variances are not negative");
  } else {
    require(!prior.failure.message().empty(), "without a normal it says why");
  }
  if (!prior.hasRotation()) return;
  require(prior.rotation.norm() < 4, "a rotation is at most half a turn");
  require(prior.rotation_covariance.diagonal().minCoeff() > 0, "a rotation is never certain");
}

}  // namespace

void fuzzImu(const uint8_t* data, size_t size) {
  silenceLog();
  Input input(data, size);
  ImuInput imu{ApproachAngleParameters()};
  if (input.byte() < 200) {
    tf2_msgs::TFMessage mounting = anyTransform(input);
    mounting.transforms[0].header.frame_id = "imu_link";
    mounting.transforms[0].child_frame_id = "left";
    imu.addTransforms(mounting);
  }
  for (int i = 0; input.left() > 0 && i < 100; ++i) {
    const double now = kStart + kStep * i;
    switch (input.choice(8)) {
      case 0:
        imu.addTransforms(anyTransform(input));
        break;
      case 1:
      case 2:
        expectHonest(imu.at(anyStamp(input, now), "left", Eigen::Matrix3d::Identity()));
        break;
      case 3:
        imu.covers(anyStamp(input, now));
        break;
      default:
        imu.add(anyMessage(input, now));
        break;
    }
  }
}

}  // namespace fuzz
}  // namespace uav_landing
