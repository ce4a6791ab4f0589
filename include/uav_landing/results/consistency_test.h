#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace uav_landing {

/// A test of one source of knowledge against the others on one pair: their difference, normalised by the
/// variance that it may have. The ratio is compared with a chi-square limit. So the rate of false alarms is
/// known as far as the variances are true.
struct TestResult {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string name;
  double difference = kNone;  ///< in the test's own unit (docs/integrity_tests.md)
  double variance = kNone;    ///< of the difference without a fault, unit^2
  double ratio = kNone;       ///< squared normalised difference; NaN when the test was not possible
  double limit = kNone;       ///< chi-square limit of the ratio
  int consecutive_failures = 0;

  bool possible() const { return std::isfinite(ratio); }
  bool failed() const { return ratio > limit; }
};

/// Limit that the sum of squares of this many independent standard normal errors exceeds with this
/// probability.
double chiSquareLimit(double false_alarm_rate, int degrees_of_freedom);

/// Factor k for which a normal error exceeds k sigma, to either side, with this probability.
double normalQuantile(double probability);

/// "tilt image_regions", or "" when none failed.
std::string failedTests(const std::vector<TestResult>& tests);

/// Page of all tests, with what each compares, its unit, its limit and the consequence
/// (docs/integrity_tests.md).
std::string integrityTestPage();

}  // namespace uav_landing
