#include "imu_input.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <sstream>

namespace uav_landing {
namespace {

using Covariance = boost::array<double, 9>;
constexpr double kMostVariance = 1e6;  // rad^2 or rad^2/s^2; more says nothing, and would overflow later
constexpr double kSilence = 1;         // s without a message from a sensor, after which another one may take
                                       // its place
constexpr double kMostRate = 100;      // rad/s; gyroscopes end at 4000 deg/s

bool absent(const Covariance& covariance) { return covariance[0] == -1; }

std::optional<Eigen::Matrix3d> known(const Covariance& covariance) {
  const Eigen::Matrix3d given =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(covariance.data());
  // False also when there is a NaN.
  if (!(given.array().abs() <= kMostVariance).all() || !(given.diagonal().array() > 0).all())
    return std::nullopt;
  const Eigen::Matrix3d symmetric = 0.5 * (given + given.transpose());
  if (Eigen::LLT<Eigen::Matrix3d>(symmetric).info() != Eigen::Success) return std::nullopt;
  return symmetric;
}

template <class Values>
std::string listed(const Values& values) {
  std::ostringstream out;
  for (Eigen::Index i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << values[i];
  return out.str();
}

}  // namespace

ImuReading toReading(const sensor_msgs::Imu& message) {
  constexpr double kUnitTolerance = 0.01;
  ImuReading reading;
  ImuSample& sample = reading.sample;
  sample.stamp = message.header.stamp.toSec();
  if (!absent(message.orientation_covariance)) {
    const Eigen::Quaterniond orientation(message.orientation.w, message.orientation.x, message.orientation.y,
                                         message.orientation.z);
    if (std::abs(orientation.norm() - 1) <= kUnitTolerance) {
      sample.orientation = orientation.normalized();
      sample.orientation_covariance = known(message.orientation_covariance);
    } else {
      reading.failure = {
          Reason::kInputInvalid,
          "orientation: expected a unit quaternion, got x, y, z, w = " + listed(orientation.coeffs()) +
              " (orientation_covariance[0] = -1 says that there is none)"};
    }
  }
  if (!absent(message.angular_velocity_covariance)) {
    const Eigen::Vector3d rate(message.angular_velocity.x, message.angular_velocity.y,
                               message.angular_velocity.z);
    if (rate.norm() <= kMostRate) {
      sample.angular_velocity = rate;
      sample.angular_velocity_covariance = known(message.angular_velocity_covariance);
    } else {
      reading.failure = {Reason::kInputInvalid,
                         "angular_velocity: expected at most 100 rad/s, got " + listed(rate)};
    }
  }
  if (!reading.usable() && !reading.failure)
    reading.failure = {Reason::kInputInvalid, "neither an orientation nor an angular velocity"};
  return reading;
}

Failure ImuInput::add(const sensor_msgs::Imu& message) {
  const ImuReading reading = toReading(message);
  if (message.header.frame_id != frame_) {
    // Another sensor in between must not silence the first one.
    if (!buffer_.empty() && std::abs(reading.sample.stamp - buffer_.newest()) < kSilence)
      return {Reason::kInputInvalid, "frame_id: '" + message.header.frame_id + "' after '" + frame_ +
                                         "': are there two sensors on this topic?"};
    buffer_.clear();
  }
  frame_ = message.header.frame_id;
  if (reading.usable()) buffer_.add(reading.sample);
  return reading.failure;
}

AttitudePrior ImuInput::at(const ros::Time& stamp, const std::string& left_frame,
                           const Eigen::Matrix3d& rectified_from_left) {
  const std::optional<double> before = before_;
  before_ = stamp.toSec();
  AttitudePrior none;
  if (buffer_.empty()) return none;
  if (frame_.empty()) {
    none.failure = {Reason::kTransformMissing, "the imu messages have an empty frame_id"};
    return none;
  }
  const std::optional<Eigen::Isometry3d> left_from_imu = frames_.leftFrom(left_frame, frame_);
  if (!left_from_imu) {
    none.failure = frames_.whyNotConnected(
        left_frame, frame_, "no static transform between the imu's " + frame_ + " and " + left_frame);
    return none;
  }
  return buffer_.at(*before_, before, rectified_from_left * left_from_imu->linear());
}

}  // namespace uav_landing
