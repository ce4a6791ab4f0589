#include "faults/output_score.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
// A normal error exceeds this once in 1.7 million frames. No campaign has a hundred thousand.
constexpr double kSigmas = 5;

/// known: of a finite truth. error: absolute. variance: the claimed one. matters: what a user would leave
/// unnoticed.
OutputError against(bool known, double error, double variance, double matters) {
  return {known, error / std::max(kSigmas * std::sqrt(variance), matters)};
}

// A tenth of a glide path's 3 degrees may leave its monitor unnoticed (ICAO Annex 10, volume I, 3.1.5.7).
OutputError angleError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.angle)) return {};
  return against(landing.angle_valid, std::abs(landing.approach_angle - truth.angle),
                 landing.approach_angle_variance, 0.3 * kDegree);
}

// Half a degree moves an aircraft by a metre over the last hundred. The error is the shorter way round.
OutputError yawError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.yaw)) return {};
  return against(std::isfinite(landing.yaw), std::abs(std::remainder(landing.yaw - truth.yaw, 2 * M_PI)),
                 landing.yaw_variance, 0.5 * kDegree);
}

OutputError xError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.x)) return {};
  return against(std::isfinite(landing.x), std::abs(landing.x - truth.x), landing.x_variance,
                 std::max(3.0, 0.03 * std::abs(truth.x)));
}

OutputError yError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.y)) return {};
  // std::fmax() leaves a width out that is not known.
  return against(std::isfinite(landing.y), std::abs(landing.y - truth.y), landing.y_variance,
                 std::fmax(1.5, 0.03 * truth.runway_width));
}

OutputError velocityError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.speed)) return {};
  const bool known = landing.velocity.allFinite();
  const double matters = std::max(0.3, 0.03 * truth.speed);
  // Recordings know how fast they were, and not in which direction of the camera.
  if (!truth.velocity.allFinite())
    return against(known, std::abs(landing.speed() - truth.speed), landing.speedVariance(), matters);
  const Eigen::Vector3d error = landing.velocity - truth.velocity;
  const Eigen::Vector3d towards = error.normalized();
  const double variance = towards.dot(landing.twist_covariance.topLeftCorner<3, 3>() * towards);
  return against(known, error.norm(), variance, matters);
}

// It has a protection level, which counts for what is claimed.
OutputError heightAboveRunwayError(const LandingResult& landing, const FaultTruth& truth) {
  if (!std::isfinite(truth.height_above_runway)) return {};
  return {landing.height_above_runway_known,
          std::abs(landing.height_above_runway - truth.height_above_runway) /
              landing.height_above_runway_protection_level};
}

}  // namespace

std::array<OutputError, kOutputNames.size()> outputErrors(const LandingResult& landing,
                                                          const FaultTruth& truth) {
  return {angleError(landing, truth), yawError(landing, truth),      xError(landing, truth),
          yError(landing, truth),     velocityError(landing, truth), heightAboveRunwayError(landing, truth)};
}

void OutputScore::take(const OutputError& error, bool is_faulted, double duration) {
  const bool misleads = error.misleads();
  misled_for_ = misleads ? misled_for_ + duration : 0;
  time_to_alert = std::max(time_to_alert, misled_for_);
  (is_faulted ? faulted_known : healthy_known) += error.known;
  (is_faulted ? misleading : healthy_misleading) += misleads;
  if (is_faulted && error.known) worst_ratio = std::max(worst_ratio, error.ratio);
}

}  // namespace uav_landing
