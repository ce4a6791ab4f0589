#include "uav_landing/results/consistency_test.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace uav_landing {

double chiSquareLimit(double false_alarm_rate, int degrees_of_freedom) {
  const boost::math::chi_squared distribution(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(distribution, false_alarm_rate));
}

double normalQuantile(double probability) {
  return boost::math::quantile(boost::math::complement(boost::math::normal(), 0.5 * probability));
}

std::string failedTests(const std::vector<TestResult>& tests) {
  std::string names;
  for (const TestResult& test : tests)
    if (test.failed()) names += (names.empty() ? "" : " ") + test.name;
  return names;
}

}  // namespace uav_landing
