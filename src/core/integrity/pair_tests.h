#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "integrity/test_catalogue.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

/// What the tests of the catalogue say of one pair. Each is compared with the limit of its line there.
class PairTests {
 public:
  /// gate: sigmas.
  PairTests(double false_alarm_rate, double gate);

  /// One difference with its variance; nothing when they are not finite and positive.
  void add(IntegrityTest test, double difference, double variance);
  /// The same where only positive differences are wrong.
  void addOneSided(IntegrityTest test, double difference, double variance);
  /// The same for the largest of several differences.
  void addLargest(IntegrityTest test, double difference, double variance, int count);
  /// Several numbers at once. difference: the size that is reported.
  void add(IntegrityTest test, const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);
  /// A squared normalised difference that was found elsewhere.
  void addRatio(IntegrityTest test, double difference, double ratio);

  bool failed(IntegrityTest test) const { return result(test).failed(); }
  /// The first that failed of those that are made in this step and have this consequence.
  std::optional<IntegrityTest> firstFailed(TestStep step, OnFailure consequence) const;
  const TestResult& result(IntegrityTest test) const { return results_[static_cast<int>(test)]; }

 private:
  TestResult& of(IntegrityTest test) { return results_[static_cast<int>(test)]; }
  /// As the catalogue has it. count: of tests of which this is the largest. degrees: of freedom.
  double limitOf(IntegrityTest test, int degrees = 1, int count = 1) const;

  double false_alarm_rate_, gate_;
  std::array<TestResult, kIntegrityTests> results_;
};

/// Counts each test's failures in a row.
class FailureCounts {
 public:
  /// After the last test of a pair: its results, with the counts.
  std::vector<TestResult> count(const PairTests& pair);

 private:
  std::array<int, kIntegrityTests> in_a_row_{};
};

}  // namespace uav_landing
