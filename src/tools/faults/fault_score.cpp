#include "faults/fault_score.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
void FaultScore::take(const LandingResult& landing, const FaultTruth& truth, bool is_faulted,
                      double duration) {
  const auto errors = outputErrors(landing, truth);
  for (size_t i = 0; i < errors.size(); ++i) outputs[i].take(errors[i], is_faulted, duration);
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

std::string FaultScore::testCounts() const {
  std::string text;
  for (const auto& [name, count] : tests)
    text += (text.empty() ? "" : ";") + name + " " + std::to_string(count.made) + " " +
            std::to_string(count.failed);
  return text;
}

}  // namespace uav_landing
