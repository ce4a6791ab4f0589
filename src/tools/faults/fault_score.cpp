#include "faults/fault_score.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

void FaultScore::take(const LandingResult& landing, double true_height, bool is_faulted, double duration) {
  if (!std::isfinite(true_height)) return;
  const bool valid = landing.height_valid;
  const double error = std::abs(landing.height - true_height);
  const bool over_level = valid && !(error <= landing.height_protection_level);
  const bool over_limit = valid && !(error <= landing.height_alert_limit);
  misled_for_ = over_limit ? misled_for_ + duration : 0;
  time_to_alert = std::max(time_to_alert, misled_for_);
  if (!is_faulted) {
    ++healthy;
    healthy_valid += valid;
    healthy_uncertain += !valid && landing.status == Status::kTracking &&
                         failedTests(landing.tests).empty() &&
                         !(landing.height_protection_level <= landing.height_alert_limit);
    healthy_misleading += over_level || over_limit;
    for (const TestResult& test : landing.tests) {
      if (!test.possible()) continue;
      ++tests[test.name].made;
      tests[test.name].failed += test.failed();
    }
    return;
  }
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

std::string FaultScore::testCounts() const {
  std::string text;
  for (const auto& [name, count] : tests)
    text += (text.empty() ? "" : ";") + name + " " + std::to_string(count.made) + " " +
            std::to_string(count.failed);
  return text;
}

}  // namespace uav_landing
