#include "faults/fault_score.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kSigmas = 5;

double bound(double variance, double tolerated) { return std::max(kSigmas * std::sqrt(variance), tolerated); }

}  // namespace

// An angle has no protection level. Its bound is a number of standard deviations that a normal error exceeds
// once in 1.7 million frames. No campaign has a hundred thousand.
//
// A smaller error is not misleading when the monitor of a glide path may leave it unnoticed. This is a tenth
// of its 3 degrees (ICAO Annex 10, volume I, 3.1.5.7).
double FaultScore::angleBound(double variance) { return bound(variance, 0.3 * kDegree); }

// Half a degree moves an aircraft by a metre over the last hundred.
double FaultScore::yawBound(double variance) { return bound(variance, 0.5 * kDegree); }

void FaultScore::take(const LandingResult& landing, const FaultTruth& truth, bool is_faulted,
                      double duration) {
  takeAngle(landing, truth.angle, is_faulted);
  takeYaw(landing, truth.yaw, is_faulted);
  if (!std::isfinite(truth.height)) return;
  const bool valid = landing.height_valid;
  const double error = std::abs(landing.height - truth.height);
  const bool over_level = valid && !(error <= landing.height_protection_level);
  const bool over_limit = valid && !(error <= landing.height_alert_limit);
  misled_for_ = over_limit ? misled_for_ + duration : 0;
  time_to_alert = std::max(time_to_alert, misled_for_);
  if (!is_faulted) return takeHealthy(landing, over_level || over_limit);
  ++faulted;
  faulted_valid += valid;
  beyond_level += over_level;
  beyond_limit += over_limit;
  misleading += over_level || over_limit;
  if (valid) {
    worst_level_ratio = std::max(worst_level_ratio, error / landing.height_protection_level);
    worst_limit_ratio = std::max(worst_limit_ratio, error / landing.height_alert_limit);
  } else if (alarm.empty()) {
    alarm = toString(landing.failure.reason);
    const std::string failed = failedTests(landing.tests);
    if (!failed.empty()) alarm += ": " + failed;
  }
}

void FaultScore::takeHealthy(const LandingResult& landing, bool misleads) {
  const bool valid = landing.height_valid;
  ++healthy;
  healthy_valid += valid;
  healthy_uncertain += !valid && landing.status == Status::kTracking && failedTests(landing.tests).empty() &&
                       !(landing.height_protection_level <= landing.height_alert_limit);
  healthy_misleading += misleads;
  for (const TestResult& test : landing.tests) {
    if (!test.possible()) continue;
    ++tests[test.name].made;
    tests[test.name].failed += test.failed();
  }
}

void FaultScore::takeAngle(const LandingResult& landing, double true_angle, bool is_faulted) {
  if (!std::isfinite(true_angle) || !landing.angle_valid) return;
  const double ratio =
      std::abs(landing.approach_angle - true_angle) / angleBound(landing.approach_angle_variance);
  const bool misleads = !(ratio <= 1);
  if (!is_faulted) {
    healthy_angle_misleading += misleads;
    return;
  }
  ++faulted_angle_valid;
  angle_misleading += misleads;
  worst_angle_ratio = std::max(worst_angle_ratio, ratio);
}

// An unknown yaw is not finite.
void FaultScore::takeYaw(const LandingResult& landing, double true_yaw, bool is_faulted) {
  if (!std::isfinite(true_yaw) || !std::isfinite(landing.yaw)) return;
  // The shorter way round the circle.
  const double error = std::abs(std::remainder(landing.yaw - true_yaw, 2 * M_PI));
  const double ratio = error / yawBound(landing.yaw_variance);
  const bool misleads = !(ratio <= 1);
  if (!is_faulted) {
    ++healthy_yaw_known;
    healthy_yaw_misleading += misleads;
    return;
  }
  ++faulted_yaw_known;
  yaw_misleading += misleads;
  worst_yaw_ratio = std::max(worst_yaw_ratio, ratio);
}

std::string FaultScore::testCounts() const {
  std::string text;
  for (const auto& [name, count] : tests)
    text += (text.empty() ? "" : ";") + name + " " + std::to_string(count.made) + " " +
            std::to_string(count.failed);
  return text;
}

}  // namespace uav_landing
