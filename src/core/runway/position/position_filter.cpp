#include "runway/position/position_filter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimation/aircraft.h"
#include "geometry/rotation.h"
#include "height/attitude_filter.h"
#include "runway/direction/runway_object.h"

namespace uav_landing {
namespace {

constexpr double kAlongError = 0.01;  // share of the distance flown, 1 sigma
// Share of the distance flown, 1 sigma: error of the runway's direction, rad.
constexpr double kAcrossError = 0.005;
constexpr double kBlindError = 0.2;  // share of the distance flown, 1 sigma, while the motion is not measured
constexpr double kWorthlessX = 0.5;  // 1 sigma as a share of the runway's width
constexpr double kWorthlessY = 0.1;  // 1 sigma as a share of the runway's width
constexpr double kMattersY = 1.5, kMattersYShare = 0.03;  // errors of y that matter: m, share of the width
constexpr double kLongMeasured = 1;                       // s

}  // namespace

PositionFilter::PositionFilter(const KalmanHeightParameters& parameters) : separation_(parameters) {}

void PositionFilter::process(const ApproachAngleResult& approach, const Eigen::Vector3d& normal,
                             const ApproachAngleResult::Motion& turn,
                             const PositionSeparation::Height& height, LandingResult& result) {
  const double h = height.value;
  const double seconds = last_stamp_ ? result.stamp - *last_stamp_ : 0;
  last_stamp_ = result.stamp;
  const bool is_runway = approach.other_runway_probability <= kLargestDoubtOfEdges;
  followDirection(is_runway ? approach.vanishing_direction : Eigen::Vector3d::Constant(kUnknown), turn,
                  seconds);
  move(approach, normal, h, seconds);
  const ApproachAngleResult::Runway& seen = approach.runway;
  const auto metric = [&](double ratio, double variance) {
    return variance * h * h + ratio * ratio * height.variance;
  };
  y_carried_ += seconds;
  if (std::isfinite(h) && !seen.failure && seen.y_variance > 0) {
    if (std::isfinite(seen.width)) {
      result.runway_width = width_ = seen.width * h;
      result.runway_width_variance = metric(seen.width, seen.width_variance);
    }
    const bool accepted = y_.update(seen.y * h, metric(seen.y, seen.y_variance), 0, seconds);
    separation_.update(seen.y_without, height, seconds);
    if (accepted) {
      y_carried_ = 0;
      y_contradicted_ = separation_.contradicts(y_.value(), std::max(kMattersY, kMattersYShare * width_));
    }
    if (!seen.threshold_failure && seen.x_variance > 0)
      x_.update(seen.x * h, metric(seen.x, seen.x_variance), seen.x_systematic_variance * h * h, seconds);
  }
  x_.forgetAbove(kWorthlessX * width_);
  y_.forgetAbove(kWorthlessY * width_);
  separation_.forgetAbove(kWorthlessY * width_);
  if (x_.known()) {
    result.x = x_.value();
    result.x_variance = x_.variance();
  }
  if (!y_.known() || y_contradicted_) return;
  const double level = separation_.protectionLevel(y_.value(), y_.variance());
  // Edges that nothing checks are not carried on for longer than they were measured, unless that was long.
  const bool lasting = y_carried_ <= y_.measured() || y_.measured() >= kLongMeasured;
  if (!std::isfinite(level) && !lasting) return;
  result.y = y_.value();
  result.y_variance = y_.variance();
  result.y_protection_level = level;
}

void PositionFilter::followDirection(const Eigen::Vector3d& seen, const ApproachAngleResult::Motion& turn,
                                     double seconds) {
  if (seen.allFinite()) {
    direction_ = seen;
    unseen_turn_ = 0;
  } else if (turn.rotation.allFinite()) {
    direction_ = rotationMatrix(turn.rotation) * direction_;
  } else {
    unseen_turn_ += aircraft::kTurnRate * seconds;
  }
}

void PositionFilter::move(const ApproachAngleResult& approach, const Eigen::Vector3d& normal, double height,
                          double seconds) {
  const ApproachAngleResult::Motion& step = approach.step;
  const bool moved = !step.failure && step.translation_over_height.allFinite() && step.rotation.allFinite();
  if (moved && std::isfinite(height) && direction_.allFinite() && normal.allFinite()) {
    const Eigen::Vector3d forward = (direction_ - normal.dot(direction_) * normal).normalized();
    // This step began before the previous pair, and the earlier part of it has already been guessed.
    const double share = seconds > 0 && step.duration > seconds ? seconds / step.duration : 1;
    const Eigen::Vector3d t = share * height * step.translation_over_height;
    const Eigen::Vector2d movement(forward.dot(t), forward.cross(normal).dot(t));
    x_.predict(movement.x(), kAlongError * t.norm() + unseen_turn_ * std::abs(movement.y()));
    moveAcross(movement.y(), kAcrossError * t.norm() + unseen_turn_ * std::abs(movement.x()));
    if (step.duration > 0) velocity_ = movement / (share * step.duration);
    return;
  }
  const Eigen::Vector2d movement = velocity_.value_or(Eigen::Vector2d::Zero()) * seconds;
  const double unseen = kBlindError * movement.norm();
  x_.predict(movement.x(), unseen);
  moveAcross(movement.y(), unseen);
}

void PositionFilter::moveAcross(double movement, double stddev) {
  y_.predict(movement, stddev);
  separation_.predict(movement, stddev);
}

}  // namespace uav_landing
