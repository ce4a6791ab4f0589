#include "runway_path.h"

#include <algorithm>
#include <cmath>

#include "body_pose.h"

namespace uav_landing {
namespace {

constexpr double kStartStddev = 1000;  // m: a finite number for "not known"
// Error of the speed that does not average out, 1 sigma as a share of the speed: first while the motion is
// seen, then while it is not.
constexpr double kSpeedError = 0.05, kOldSpeedError = 1;
constexpr size_t kTrackPoints = 2000;
constexpr double kTrackSpacing = 0.02;  // of the height
constexpr double kMaxStart = 100;  // heights, because a path that hardly descends meets the ground far away
constexpr int kMeanOf = 20;        // number of widths in the mean

}  // namespace

std::optional<RunwayPath::Position> RunwayPath::update(const LandingResult& camera) {
  if (last_stamp_ && camera.stamp <= *last_stamp_) reset();
  if (std::isfinite(camera.runway_width)) {
    widths_ = std::min(widths_ + 1, kMeanOf);
    runway_width_ += (camera.runway_width - runway_width_) / widths_;
  }
  const Eigen::Matrix3d rotation = runwayFromCamera(camera);
  const bool seen = rotation.allFinite() && camera.velocity.allFinite();
  if (seen) velocity_ = (rotation * camera.velocity).head<2>();
  if (last_stamp_) {
    const double T = camera.stamp - *last_stamp_;
    xy_ += velocity_ * T;
    drift_stddev_ += (seen ? kSpeedError : kOldSpeedError) * velocity_.norm() * T;
    last_stamp_ = camera.stamp;
  }
  if (!camera.height_valid || !std::isfinite(camera.height) || !rotation.allFinite()) return std::nullopt;
  if (!last_stamp_) {
    const double slope = camera.angle_valid ? std::tan(camera.approach_angle) : 0;
    xy_ = {slope > 1 / kMaxStart ? -camera.height / slope : -kMaxStart * camera.height, 0};
    last_stamp_ = camera.stamp;
  }
  const double unknown = kStartStddev * kStartStddev + drift_stddev_ * drift_stddev_;
  Eigen::Vector2d variance(unknown, unknown);
  takeKnown(0, camera.x, camera.x_variance, variance);
  takeKnown(1, camera.y, camera.y_variance, variance);
  const Eigen::Vector3d position(xy_.x(), xy_.y(), camera.height);
  remember(position);
  return Position{position, variance};
}

void RunwayPath::takeKnown(int axis, double value, double value_variance, Eigen::Vector2d& variance) {
  if (!std::isfinite(value)) {
    known_[axis] = false;
    return;
  }
  // When the runway is found, the path so far, drawn from an arbitrary start, moves with the aircraft.
  if (!known_[axis])
    for (Eigen::Vector3d& point : track_) point[axis] += value - xy_[axis];
  known_[axis] = true;
  xy_[axis] = value;
  variance[axis] = value_variance;
}

void RunwayPath::remember(const Eigen::Vector3d& position) {
  if (!track_.empty() && (position - track_.back()).norm() < kTrackSpacing * position.z()) return;
  track_.push_back(position);
  if (track_.size() > kTrackPoints) track_.pop_front();
}

void RunwayPath::reset() { *this = RunwayPath(); }

}  // namespace uav_landing
