#include "tools/faults/fault_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// Of 3 degrees, off by error_deg.
LandingResult angleOff(double error_deg, double stddev_deg, bool valid = true) {
  LandingResult landing;
  landing.approach_angle = (3 + error_deg) * kDegree;
  landing.approach_angle_variance = std::pow(stddev_deg * kDegree, 2);
  landing.angle_valid = valid;
  return landing;
}

TEST(FaultScore, AnAngleMisleadsBeyondFiveStandardDeviationsAndATenthOfAGlidePath) {
  const auto misleads = [](const LandingResult& landing) {
    FaultScore score;
    score.take(landing, {kUnknown, 3 * kDegree, kUnknown}, true, 0.05);
    return score.angle_misleading == 1;
  };
  EXPECT_FALSE(misleads(angleOff(0.29, 0.01))) << "29 sigma of nothing that matters";
  EXPECT_TRUE(misleads(angleOff(0.31, 0.01)));
  EXPECT_TRUE(misleads(angleOff(-0.31, 0.06)));
  EXPECT_FALSE(misleads(angleOff(-0.31, 0.063))) << "4.9 sigma";
  EXPECT_TRUE(misleads(angleOff(2.6, 0.5)));
  EXPECT_FALSE(misleads(angleOff(2.4, 0.5)));
  EXPECT_FALSE(misleads(angleOff(9, 0.01, false)));
  EXPECT_TRUE(misleads(angleOff(kUnknown, 0.01))) << "valid, and no number";
}

TEST(FaultScore, CountsAnglesBeforeAndAfterTheOnsetApartAndOnlyWhereTheyAreKnown) {
  FaultScore score;
  const FaultTruth truth{kUnknown, 3 * kDegree, kUnknown};
  for (int i = 0; i < 3; ++i) score.take(angleOff(1, 0.1), truth, false, 0.05);
  for (int i = 0; i < 2; ++i) score.take(angleOff(0.8, 0.1), truth, true, 0.05);
  score.take(angleOff(0.2, 0.1), truth, true, 0.05);
  score.take(angleOff(0.9, 0.1, false), truth, true, 0.05);
  score.take(angleOff(0.9, 0.1), {}, true, 0.05);
  EXPECT_EQ(score.healthy_angle_misleading, 3);
  EXPECT_EQ(score.faulted_angle_valid, 3);
  EXPECT_EQ(score.angle_misleading, 2);
  EXPECT_NEAR(score.worst_angle_ratio, 0.8 / 0.5, 1e-9);
}

/// Of 20 degrees to the right, off by error_deg.
LandingResult yawOff(double error_deg, double stddev_deg) {
  LandingResult landing;
  landing.yaw = (-20 + error_deg) * kDegree;
  landing.yaw_variance = std::pow(stddev_deg * kDegree, 2);
  return landing;
}

TEST(FaultScore, AKnownYawMisleadsBeyondFiveStandardDeviationsAndHalfADegree) {
  const auto misleads = [](const LandingResult& landing, double true_deg = -20) {
    FaultScore score;
    score.take(landing, {kUnknown, kUnknown, true_deg * kDegree}, true, 0.05);
    return score.yaw_misleading == 1;
  };
  EXPECT_FALSE(misleads(yawOff(0.49, 0.01))) << "49 sigma of nothing that matters";
  EXPECT_TRUE(misleads(yawOff(0.51, 0.01)));
  EXPECT_TRUE(misleads(yawOff(-0.51, 0.1)));
  EXPECT_FALSE(misleads(yawOff(-0.51, 0.103))) << "less than 5 sigma";
  EXPECT_TRUE(misleads(yawOff(8, 1.5)));
  EXPECT_FALSE(misleads(yawOff(7, 1.5)));
  EXPECT_FALSE(misleads(yawOff(kUnknown, 0.01))) << "not known";
  EXPECT_FALSE(misleads(yawOff(360.2, 0.01))) << "once round";
  EXPECT_TRUE(misleads(yawOff(0, kUnknown), -19)) << "known, and claims nothing";
}

TEST(FaultScore, CountsYawsBeforeAndAfterTheOnsetApartAndOnlyWhereTheyAreKnown) {
  FaultScore score;
  const FaultTruth truth{kUnknown, kUnknown, -20 * kDegree};
  for (int i = 0; i < 3; ++i) score.take(yawOff(1, 0.1), truth, false, 0.05);
  score.take(yawOff(0.1, 0.1), truth, false, 0.05);
  for (int i = 0; i < 2; ++i) score.take(yawOff(-0.8, 0.1), truth, true, 0.05);
  score.take(yawOff(0.2, 0.1), truth, true, 0.05);
  score.take(yawOff(kUnknown, kUnknown), truth, true, 0.05);
  score.take(yawOff(0.9, 0.1), {}, true, 0.05);
  EXPECT_EQ(score.healthy_yaw_known, 4);
  EXPECT_EQ(score.healthy_yaw_misleading, 3);
  EXPECT_EQ(score.faulted_yaw_known, 3);
  EXPECT_EQ(score.yaw_misleading, 2);
  EXPECT_NEAR(score.worst_yaw_ratio, 0.8 / 0.5, 1e-9);
  EXPECT_EQ(score.angle_misleading, 0);
}

TEST(FaultScore, AHeightMisleadsBeyondItsProtectionLevelOrAlertLimitWhateverTheAngleIs) {
  FaultScore score;
  LandingResult landing = angleOff(9, 0.01);
  landing.height_valid = true;
  landing.height = 10;
  landing.height_protection_level = 0.4;
  landing.height_alert_limit = 0.5;
  for (const double true_height : {10.3, 10.45, 9.4})
    score.take(landing, {true_height, kUnknown, kUnknown}, true, 0.05);
  EXPECT_EQ(score.faulted_valid, 3);
  EXPECT_EQ(score.beyond_level, 2);
  EXPECT_EQ(score.beyond_limit, 1);
  EXPECT_EQ(score.misleading, 2);
  EXPECT_EQ(score.angle_misleading, 0);
  EXPECT_NEAR(score.worst_level_ratio, 0.6 / 0.4, 1e-9);
}

}  // namespace
}  // namespace uav_landing
