#include "uav_landing/simulator/trajectory.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace {

constexpr double kRadiansPerDegree = boost::math::constants::degree<double>();
constexpr double kTwoPi = boost::math::constants::two_pi<double>();

/// Integral of (cos, sin) of an angle that changes from a to b at a constant rate. duration: of the change.
Eigen::Vector2d arc(double a, double b, double duration) {
  // sinc of half the difference is exact, also when a and b are equal.
  const double half = 0.5 * (b - a), middle = 0.5 * (a + b);
  const double sinc = std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
  return duration * sinc * Eigen::Vector2d(std::cos(middle), std::sin(middle));
}

}  // namespace

Trajectory::Trajectory(const SimulatedPathParameters& path, const SimulatedWobbleParameters& wobble,
                       const SimulatedGustParameters& gust, uint64_t seed,
                       const SimulatedVibrationParameters& vibration)
    : path_(path), gust_(gust), vibration_(vibration), flare_start_(std::numeric_limits<double>::infinity()) {
  const double sink = path.speed * std::sin(path.glide_angle_deg * kRadiansPerDegree);
  if (path.flare_height > 0 && sink > 0)
    flare_start_ = std::max(0.0, (path.start_height - path.flare_height) / sink);
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 2);
  const auto make = [&](double amplitude, double period) {
    const double phase = random.uniform(0.0, kTwoPi), fast_phase = random.uniform(0.0, kTwoPi);
    return Wobble{amplitude, period, phase, fast_phase};
  };
  roll_ = make(wobble.roll_deg * kRadiansPerDegree, wobble.roll_period);
  pitch_ = make(wobble.pitch_deg * kRadiansPerDegree, wobble.pitch_period);
  yaw_ = make(wobble.yaw_deg * kRadiansPerDegree, wobble.yaw_period);
  sway_ = make(wobble.sway, wobble.sway_period);
  heave_ = make(wobble.heave, wobble.heave_period);
  for (double* phase : {&vibration_phase_.roll, &vibration_phase_.pitch, &vibration_phase_.yaw})
    *phase = random.uniform(0.0, kTwoPi);
}

double Trajectory::Wobble::at(double t) const {
  // The sum of both sines never exceeds the amplitude.
  const double angle = kTwoPi * t / period;
  return amplitude * (std::sin(angle + phase) + 0.4 * std::sin(2.7 * angle + fast_phase)) / 1.4;
}

Eigen::Vector2d Trajectory::advance(double t) const {
  const double glide = path_.glide_angle_deg * kRadiansPerDegree,
               end = path_.flare_angle_deg * kRadiansPerDegree;
  Eigen::Vector2d way = arc(glide, glide, std::min(t, flare_start_));
  if (t > flare_start_) {
    const double in_flare = std::min(t - flare_start_, path_.flare_duration);
    way += arc(glide, glide + (end - glide) * in_flare / path_.flare_duration, in_flare);
    way += arc(end, end, std::max(0.0, t - flare_start_ - path_.flare_duration));
  }
  return path_.speed * way;
}

double Trajectory::lostToGust(double t) const {
  // The integral of speed (1 - cos(2 pi t / duration)) / 2.
  const double in_gust = std::clamp(t - gust_.start, 0.0, gust_.duration);
  const double period = gust_.duration / kTwoPi;
  return 0.5 * gust_.speed * (in_gust - period * std::sin(in_gust / period));
}

Attitude Trajectory::vibrationAt(double t) const {
  const double periods = (t - vibration_.start) * vibration_.frequency;
  const double grown = vibration_.start > 0 ? std::clamp(periods, 0.0, 1.0) : 1;
  const auto sine = [&](double degrees, double phase) {
    return grown * degrees * kRadiansPerDegree * std::sin(kTwoPi * periods + phase);
  };
  Attitude added;
  added.roll = sine(vibration_.roll_deg, vibration_phase_.roll);
  added.pitch = sine(vibration_.pitch_deg, vibration_phase_.pitch);
  added.yaw = sine(vibration_.yaw_deg, vibration_phase_.yaw);
  return added;
}

CameraPose Trajectory::pose(double t) const {
  const Eigen::Vector2d way = advance(t);
  const double track = path_.track_deg * kRadiansPerDegree;
  const double flared = std::clamp((t - flare_start_) / path_.flare_duration, 0.0, 1.0);
  const Attitude vibration = vibrationAt(t);
  CameraPose pose;
  pose.position = {path_.start_x + way.x() * std::cos(track),
                   path_.start_y + way.x() * std::sin(track) + sway_.at(t),
                   path_.start_height - way.y() + heave_.at(t) - lostToGust(t)};
  pose.attitude.roll = path_.roll_deg * kRadiansPerDegree + roll_.at(t) + vibration.roll;
  pose.attitude.pitch =
      (path_.pitch_deg + flared * path_.flare_pitch_deg) * kRadiansPerDegree + pitch_.at(t) + vibration.pitch;
  pose.attitude.yaw = path_.yaw_deg * kRadiansPerDegree + yaw_.at(t) + vibration.yaw;
  return pose;
}

Truth truthOf(const CameraPose& pose, const CameraPose* previous, double dt, const Eigen::Matrix3d& K) {
  Truth truth;
  truth.height = pose.position.z();
  truth.roll = pose.attitude.roll;
  truth.pitch = pose.attitude.pitch;
  truth.yaw = pose.attitude.yaw;
  truth.x = pose.position.x();
  truth.y = pose.position.y();
  if (previous == nullptr) return truth;
  const Eigen::Vector3d step = pose.position - previous->position;
  truth.speed = step.norm() / dt;
  if (step.norm() == 0) return truth;
  truth.approach_angle = std::asin(-step.z() / step.norm());
  const Eigen::Vector3d image = K * runwayFromOptical(pose.attitude).transpose() * step;
  if (image.z() > 0) truth.foe = image.head<2>() / image.z();
  return truth;
}

}  // namespace uav_landing
