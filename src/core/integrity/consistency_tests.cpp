#include "uav_landing/integrity/consistency_tests.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace uav_landing {

const char* toString(Consistency test) {
  switch (test) {
    case Consistency::kRepeatedImage:
      return "repeated_image";
    case Consistency::kPhotometric:
      return "photometric";
    case Consistency::kRowAgreement:
      return "row_agreement";
    case Consistency::kRigRotation:
      return "rig_rotation";
    case Consistency::kBaselineDirection:
      return "baseline_direction";
    case Consistency::kStandstill:
      return "standstill";
    case Consistency::kVelocity:
      return "velocity";
    case Consistency::kTilt:
      return "tilt";
    case Consistency::kVanishingPoint:
      return "vanishing_point";
    case Consistency::kMotionNormal:
      return "motion_normal";
    case Consistency::kImu:
      return "imu";
    case Consistency::kImageRegions:
      return "image_regions";
    case Consistency::kRunwayWidth:
      return "runway_width";
    case Consistency::kInnovation:
      return "innovation";
    case Consistency::kSinkRate:
      return "sink_rate";
  }
  return "";
}

ConsistencyTests::ConsistencyTests(double false_alarm_rate) : false_alarm_rate_(false_alarm_rate) {
  for (int i = 0; i < kConsistencyTests; ++i) tests_[i].name = toString(static_cast<Consistency>(i));
}

void ConsistencyTests::begin() {
  for (TestResult& test : tests_)
    test.difference = test.variance = test.ratio = test.limit = TestResult::kNone;
}

void ConsistencyTests::add(Consistency test, double difference, double variance) {
  addLargest(test, difference, variance, 1);
}

void ConsistencyTests::addOneSided(Consistency test, double difference, double variance) {
  addLargest(test, difference, variance, 1);
  if (difference < 0) of(test).ratio = 0;
}

void ConsistencyTests::addLargest(Consistency test, double difference, double variance, int count) {
  if (!std::isfinite(difference) || !(variance > 0)) return;
  TestResult& result = of(test);
  result.difference = difference;
  result.variance = variance;
  result.ratio = difference * difference / variance;
  result.limit = chiSquareLimit(false_alarm_rate_ / count, 1);
}

void ConsistencyTests::add(Consistency test, const Eigen::VectorXd& difference,
                           const Eigen::MatrixXd& covariance) {
  const double ratio = difference.dot(covariance.ldlt().solve(difference));
  if (!std::isfinite(ratio) || !(ratio >= 0)) return;
  const int count = static_cast<int>(difference.size());
  TestResult& result = of(test);
  result.difference = difference.norm();
  result.variance = covariance.trace() / count;
  result.ratio = ratio;
  result.limit = chiSquareLimit(false_alarm_rate_, count);
}

void ConsistencyTests::addRatio(Consistency test, double difference, double ratio, double limit) {
  TestResult& result = of(test);
  result.difference = difference;
  result.variance = difference * difference / ratio;
  result.ratio = ratio;
  result.limit = limit;
}

std::vector<TestResult> ConsistencyTests::finish() {
  for (TestResult& test : tests_)
    test.consecutive_failures = test.failed() ? test.consecutive_failures + 1 : 0;
  return {tests_.begin(), tests_.end()};
}

}  // namespace uav_landing
