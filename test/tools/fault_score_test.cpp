#include "tools/faults/fault_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

FaultTruth angleTruth() {
  FaultTruth truth;
  truth.angle = 3 * kDegree;
  return truth;
}

FaultTruth yawTruth(double degrees) {
  FaultTruth truth;
  truth.yaw = degrees * kDegree;
  return truth;
}

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
    score.take(landing, angleTruth(), true, 0.05);
    return score.of(Output::kAngle).misleading == 1;
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
  const FaultTruth truth = angleTruth();
  for (int i = 0; i < 3; ++i) score.take(angleOff(1, 0.1), truth, false, 0.05);
  for (int i = 0; i < 2; ++i) score.take(angleOff(0.8, 0.1), truth, true, 0.05);
  score.take(angleOff(0.2, 0.1), truth, true, 0.05);
  score.take(angleOff(0.9, 0.1, false), truth, true, 0.05);
  score.take(angleOff(0.9, 0.1), {}, true, 0.05);
  EXPECT_EQ(score.of(Output::kAngle).healthy_misleading, 3);
  EXPECT_EQ(score.of(Output::kAngle).faulted_known, 3);
  EXPECT_EQ(score.of(Output::kAngle).misleading, 2);
  EXPECT_NEAR(score.of(Output::kAngle).worst_ratio, 0.8 / 0.5, 1e-9);
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
    score.take(landing, yawTruth(true_deg), true, 0.05);
    return score.of(Output::kYaw).misleading == 1;
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
  const FaultTruth truth = yawTruth(-20);
  for (int i = 0; i < 3; ++i) score.take(yawOff(1, 0.1), truth, false, 0.05);
  score.take(yawOff(0.1, 0.1), truth, false, 0.05);
  for (int i = 0; i < 2; ++i) score.take(yawOff(-0.8, 0.1), truth, true, 0.05);
  score.take(yawOff(0.2, 0.1), truth, true, 0.05);
  score.take(yawOff(kUnknown, kUnknown), truth, true, 0.05);
  score.take(yawOff(0.9, 0.1), {}, true, 0.05);
  EXPECT_EQ(score.of(Output::kYaw).healthy_known, 4);
  EXPECT_EQ(score.of(Output::kYaw).healthy_misleading, 3);
  EXPECT_EQ(score.of(Output::kYaw).faulted_known, 3);
  EXPECT_EQ(score.of(Output::kYaw).misleading, 2);
  EXPECT_NEAR(score.of(Output::kYaw).worst_ratio, 0.8 / 0.5, 1e-9);
  EXPECT_EQ(score.of(Output::kAngle).misleading, 0);
}

TEST(FaultScore, AHeightMisleadsBeyondItsProtectionLevelOrAlertLimitWhateverTheAngleIs) {
  FaultScore score;
  LandingResult landing = angleOff(9, 0.01);
  landing.height_valid = true;
  landing.height = 10;
  landing.height_protection_level = 0.4;
  landing.height_alert_limit = 0.5;
  for (const double true_height : {10.3, 10.45, 9.4}) {
    FaultTruth truth;
    truth.height = true_height;
    score.take(landing, truth, true, 0.05);
  }
  EXPECT_EQ(score.faulted_valid, 3);
  EXPECT_EQ(score.beyond_level, 2);
  EXPECT_EQ(score.beyond_limit, 1);
  EXPECT_EQ(score.misleading, 2);
  EXPECT_EQ(score.of(Output::kAngle).misleading, 0);
  EXPECT_NEAR(score.worst_level_ratio, 0.6 / 0.4, 1e-9);
}

bool misleads(Output output, const LandingResult& landing, const FaultTruth& truth) {
  return outputErrors(landing, truth)[static_cast<size_t>(output)].misleads();
}

TEST(FaultScore, APlaceAlongTheRunwayMisleadsBeyondThreePerCentOfTheDistanceOrThreeMetres) {
  FaultTruth truth;
  LandingResult landing;
  landing.x_variance = 0.25;
  const auto wrong = [&](double distance, double error) {
    truth.x = -distance;
    landing.x = error - distance;
    return misleads(Output::kX, landing, truth);
  };
  EXPECT_FALSE(wrong(1000, 29));
  EXPECT_TRUE(wrong(1000, -31));
  EXPECT_FALSE(wrong(20, -2.9));
  EXPECT_TRUE(wrong(20, 3.1));
  landing.x_variance = 49;
  EXPECT_FALSE(wrong(20, 34)) << "less than 5 sigma";
  EXPECT_TRUE(wrong(20, 36));
  landing.x = kUnknown;
  EXPECT_FALSE(misleads(Output::kX, landing, truth)) << "not known";
}

TEST(FaultScore, APlaceBesideTheCentreLineMisleadsByThreePerCentOfTheWidthAndAtLeastByAMetreAndAHalf) {
  FaultTruth truth;
  LandingResult landing;
  landing.y_variance = 0.01;
  const auto wrong = [&](double width, double error) {
    truth.runway_width = width;
    truth.y = -2;
    landing.y = error - 2;
    return misleads(Output::kY, landing, truth);
  };
  EXPECT_FALSE(wrong(30, 1.4));
  EXPECT_TRUE(wrong(30, -1.6));
  EXPECT_FALSE(wrong(60, 1.7));
  EXPECT_TRUE(wrong(60, 1.9));
  EXPECT_TRUE(wrong(kUnknown, 1.6)) << "a recording, whose width nobody has told";
}

TEST(FaultScore, AVelocityMisleadsByItsDirectionToo) {
  FaultTruth truth;
  truth.velocity = {0, 1, 20};
  truth.speed = truth.velocity.norm();
  LandingResult landing;
  landing.twist_covariance = Matrix6d::Identity() * 1e-4;
  const auto wrong = [&](const Eigen::Vector3d& error) {
    landing.velocity = truth.velocity + error;
    return misleads(Output::kVelocity, landing, truth);
  };
  EXPECT_FALSE(wrong({0, 0, 0.59})) << "3 % of 20 m/s";
  EXPECT_TRUE(wrong({0, 0, -0.61}));
  EXPECT_TRUE(wrong({0.61, 0, 0})) << "as fast, and aside";
  landing.twist_covariance(0, 0) = 0.04;
  EXPECT_FALSE(wrong({0.99, 0, 0})) << "5 sigma of this direction";
  EXPECT_TRUE(wrong({1.01, 0, 0}));
  EXPECT_TRUE(wrong({0, 0.61, 0})) << "not that of another";
  truth.velocity.setConstant(kUnknown);
  landing.velocity = {20, 0, 1};
  EXPECT_FALSE(misleads(Output::kVelocity, landing, truth)) << "a recording knows the speed alone";
  landing.velocity = {21.5, 0, 1};
  EXPECT_TRUE(misleads(Output::kVelocity, landing, truth));
}

TEST(FaultScore, AHeightAboveTheRunwayMisleadsBeyondItsProtectionLevel) {
  FaultTruth truth;
  truth.height_above_runway = 12;
  LandingResult landing;
  landing.height_above_runway = 12.5;
  landing.height_above_runway_known = true;
  landing.height_above_runway_protection_level = 0.6;
  EXPECT_FALSE(misleads(Output::kHeightAboveRunway, landing, truth));
  landing.height_above_runway_protection_level = 0.4;
  EXPECT_TRUE(misleads(Output::kHeightAboveRunway, landing, truth));
  landing.height_above_runway_known = false;
  EXPECT_FALSE(misleads(Output::kHeightAboveRunway, landing, truth));
}

TEST(FaultScore, TimeToAlertIsTheLongestTimeInARowThatAnOutputMisled) {
  FaultScore score;
  for (const double error : {0.6, 0.6, 0.1, 0.6, 0.6, 0.6, 0.0})
    score.take(yawOff(error, 0.01), yawTruth(-20), true, 0.05);
  EXPECT_NEAR(score.of(Output::kYaw).time_to_alert, 0.15, 1e-9);
  EXPECT_EQ(score.of(Output::kAngle).time_to_alert, 0);
}

}  // namespace
}  // namespace uav_landing
