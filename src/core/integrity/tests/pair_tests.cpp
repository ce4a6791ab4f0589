#include "integrity/tests/pair_tests.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace uav_landing {

PairTests::PairTests(double false_alarm_rate, double gate)
    : false_alarm_rate_(false_alarm_rate), gate_(gate) {
  for (const TestDescription& described : kTestCatalogue) of(described.test).name = described.name;
}

void PairTests::add(IntegrityTest test, double difference, double variance) {
  addLargest(test, difference, variance, 1);
}

void PairTests::addOneSided(IntegrityTest test, double difference, double variance) {
  addLargest(test, difference, variance, 1);
  if (difference < 0) of(test).ratio = 0;
}

void PairTests::addLargest(IntegrityTest test, double difference, double variance, int count) {
  if (!std::isfinite(difference) || !(variance > 0)) return;
  TestResult& result = of(test);
  result.difference = difference;
  result.variance = variance;
  result.ratio = difference * difference / variance;
  result.limit = limitOf(test, 1, count);
}

void PairTests::add(IntegrityTest test, const Eigen::VectorXd& difference,
                    const Eigen::MatrixXd& covariance) {
  const double ratio = difference.dot(covariance.ldlt().solve(difference));
  if (!std::isfinite(ratio) || !(ratio >= 0)) return;
  const int count = static_cast<int>(difference.size());
  TestResult& result = of(test);
  result.difference = difference.norm();
  result.variance = covariance.trace() / count;
  result.ratio = ratio;
  result.limit = limitOf(test, count);
}

void PairTests::addRatio(IntegrityTest test, double difference, double ratio) {
  TestResult& result = of(test);
  result.difference = difference;
  result.variance = difference * difference / ratio;
  result.ratio = ratio;
  result.limit = limitOf(test);
}

double PairTests::limitOf(IntegrityTest test, int degrees, int count) const {
  const TestLimit limit = descriptionOf(test).limit;
  switch (limit.kind) {
    case TestLimit::kChiSquare:
      return chiSquareLimit(false_alarm_rate_ / count, degrees);
    case TestLimit::kSquaredGate:
      return gate_ * gate_;
    case TestLimit::kFixed:
      break;
  }
  return limit.value;
}

std::optional<IntegrityTest> PairTests::firstFailed(TestStep step, OnFailure consequence) const {
  for (const TestDescription& described : kTestCatalogue)
    if (described.step == step && described.on_failure == consequence && failed(described.test))
      return described.test;
  return std::nullopt;
}

std::vector<TestResult> FailureCounts::count(const PairTests& pair) {
  std::vector<TestResult> results;
  for (const TestDescription& described : kTestCatalogue) {
    TestResult result = pair.result(described.test);
    int& in_a_row = in_a_row_[static_cast<int>(described.test)];
    in_a_row = result.failed() ? in_a_row + 1 : 0;
    result.consecutive_failures = in_a_row;
    results.push_back(result);
  }
  return results;
}

}  // namespace uav_landing
