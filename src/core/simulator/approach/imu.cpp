#include "uav_landing/simulator/imu.h"

#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

constexpr double kDegree = boost::math::constants::degree<double>();

/// Orientation of the body (forward, left, up) over the runway.
Eigen::Quaterniond bodyOrientation(const Attitude& attitude) {
  return Eigen::Quaterniond(runwayFromOptical(attitude) * bodyFromOptical().transpose());
}

Eigen::Vector3d rotationVector(const Eigen::Quaterniond& turn) {
  const Eigen::AngleAxisd rotation(turn);
  return rotation.angle() * rotation.axis();
}

Eigen::Quaterniond exponential(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle)) : Eigen::Quaterniond::Identity();
}

}  // namespace

Eigen::Matrix3d opticalFromImu() { return bodyFromOptical().transpose(); }

SimulatedImu::SimulatedImu(const SimulatedImuParameters& parameters, const Trajectory& trajectory,
                           uint64_t seed)
    : parameters_(parameters), trajectory_(trajectory), seed_(seed) {}

int SimulatedImu::count(double duration) const {
  return parameters_.rate > 0 ? 1 + static_cast<int>(std::floor(duration * parameters_.rate + 1e-6)) : 0;
}

ImuSample SimulatedImu::sample(int index) const {
  constexpr double kStep = 1e-4;  // s, of the finite differences that give the angular velocity
  const double t = index / parameters_.rate;
  const Eigen::Quaterniond before = bodyOrientation(trajectory_.pose(t - kStep).attitude);
  const Eigen::Quaterniond after = bodyOrientation(trajectory_.pose(t + kStep).attitude);

  cv::RNG random((seed_ << 32) * 0x9E3779B97F4A7C15ULL + static_cast<uint64_t>(index) + 1);
  const auto noise = [&](double stddev) {
    Eigen::Vector3d errors;
    for (int i = 0; i < 3; ++i) errors[i] = random.gaussian(stddev);
    return errors;
  };
  noise(1);  // a generator's first numbers after similar seeds are similar
  const Eigen::Vector3d tilt(parameters_.roll_error_deg, -parameters_.pitch_error_deg, 0);
  ImuSample sample;
  sample.stamp = t + parameters_.delay;
  sample.orientation = bodyOrientation(trajectory_.pose(t).attitude) *
                       exponential(kDegree * (tilt + noise(parameters_.attitude_noise_deg)));
  const Eigen::Vector3d bias(parameters_.gyro_bias_x_deg, parameters_.gyro_bias_y_deg,
                             parameters_.gyro_bias_z_deg);
  sample.angular_velocity = rotationVector(before.conjugate() * after) / (2 * kStep) +
                            kDegree * (bias + noise(parameters_.gyro_noise_deg));
  return sample;
}

}  // namespace uav_landing
