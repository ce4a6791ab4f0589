#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "integrity/tests/test_catalogue.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

/// Results of the catalogue's tests for one pair. Each is compared with the limit of its line there.
class PairTests {
 public:
  /// gate: in sigmas.
  PairTests(double false_alarm_rate, double gate);

  /// Adds one difference with its variance. It is ignored unless the difference is finite and the variance
  /// positive.
  void add(IntegrityTest test, double difference, double variance);
  /// The same when only positive differences are wrong.
  void addOneSided(IntegrityTest test, double difference, double variance);
  /// The same for the largest of `count` differences.
  void addLargest(IntegrityTest test, double difference, double variance, int count);
  /// Adds a test of several numbers at once. The size of the difference is reported.
  void add(IntegrityTest test, const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);
  /// Adds a squared normalised difference that was computed elsewhere.
  void addRatio(IntegrityTest test, double difference, double ratio);

  bool failed(IntegrityTest test) const { return result(test).failed(); }
  /// The first failed test of this step that has this consequence, in the order of the catalogue.
  std::optional<IntegrityTest> firstFailed(TestStep step, OnFailure consequence) const;
  const TestResult& result(IntegrityTest test) const { return results_[static_cast<int>(test)]; }

 private:
  TestResult& of(IntegrityTest test) { return results_[static_cast<int>(test)]; }
  /// Limit by the catalogue. degrees: degrees of freedom. count: number of tests whose largest difference is
  /// tested.
  double limitOf(IntegrityTest test, int degrees = 1, int count = 1) const;

  double false_alarm_rate_, gate_;
  std::array<TestResult, kIntegrityTests> results_;
};

/// Counts each test's failures in a row.
class FailureCounts {
 public:
  /// Call it after the last test of a pair. Returns its results, with the counts.
  std::vector<TestResult> count(const PairTests& pair);

 private:
  std::array<int, kIntegrityTests> in_a_row_{};
};

}  // namespace uav_landing
