#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

/// Which test, in the order in which they are reported. docs/integrity.md says what each compares.
enum class Consistency {
  kRepeatedImage,
  kPhotometric,
  kRowAgreement,
  kRigRotation,
  kBaselineDirection,
  kStandstill,
  kVelocity,
  kTilt,
  kVanishingPoint,
  kMotionNormal,
  kImu,
  kImageRegions,
  kRunwayWidth,
  kInnovation,
  kSinkRate
};
constexpr int kConsistencyTests = 15;
const char* toString(Consistency test);

/// The tests of one pair after another.
class ConsistencyTests {
 public:
  explicit ConsistencyTests(double false_alarm_rate);

  /// A new pair: nothing is tested yet.
  void begin();
  /// One difference with its variance; nothing when they are not finite and positive.
  void add(Consistency test, double difference, double variance);
  /// The same where only positive differences are wrong.
  void addOneSided(Consistency test, double difference, double variance);
  /// The same for the largest of several differences.
  void addLargest(Consistency test, double difference, double variance, int count);
  /// Several numbers at once. difference: the size that is reported.
  void add(Consistency test, const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);
  /// A test that was made elsewhere.
  void addRatio(Consistency test, double difference, double ratio, double limit);
  bool failed(Consistency test) const { return tests_[static_cast<int>(test)].failed(); }
  /// Of this pair, with the failures in a row of the pairs before.
  const TestResult& result(Consistency test) const { return tests_[static_cast<int>(test)]; }
  /// Forgets the failures of the pairs before.
  void reset() { *this = ConsistencyTests(false_alarm_rate_); }
  /// Counts failures in a row. After the last test of the pair.
  std::vector<TestResult> finish();

 private:
  TestResult& of(Consistency test) { return tests_[static_cast<int>(test)]; }
  double false_alarm_rate_;
  std::array<TestResult, kConsistencyTests> tests_;
};

}  // namespace uav_landing
