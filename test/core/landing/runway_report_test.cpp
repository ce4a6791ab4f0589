#include "landing/report/runway_report.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uav_landing {
namespace {

TrackedPosition outlineAt(double x, double height, double stddev) {
  TrackedPosition outline;
  outline.position = {x, 2, height};
  outline.variance = {25, 1, stddev * stddev};
  outline.protection_level = 0.1 * height;
  outline.measured = true;
  return outline;
}

/// A height by stereo known to 5 cm.
LandingResult stereoAt(double height) {
  LandingResult landing;
  landing.height_valid = true;
  landing.height = height;
  landing.height_variance = 25e-4;
  landing.height_protection_level = 0.3;
  landing.height_origin = HeightOrigin::kStereo;
  return landing;
}

TEST(RunwayReport, FromAfarTheHeightAboveTheRunwayIsByGeometry) {
  LandingResult landing;
  const TrackedPosition outline = outlineAt(-3000, 160, 4);
  handOver(outline, {}, landing);
  reportHeightAboveRunway(outline, 0, false, {}, landing);
  EXPECT_EQ(landing.x, -3000);
  EXPECT_EQ(landing.y, 2);
  EXPECT_EQ(landing.height_above_runway, 160);
  EXPECT_EQ(landing.height_above_runway_variance, 16);
  EXPECT_EQ(landing.height_above_runway_protection_level, 16);
  EXPECT_DOUBLE_EQ(landing.height_above_runway_limit, 24) << "15 % of it";
  EXPECT_TRUE(landing.height_above_runway_known);
  EXPECT_EQ(landing.height_origin, HeightOrigin::kGeometry);
  EXPECT_TRUE(std::isnan(landing.height)) << "says nothing of the ground below";
  TrackedPosition vague = outline;
  vague.protection_level = 30;
  reportHeightAboveRunway(vague, 0, false, {}, landing);
  EXPECT_EQ(landing.height_above_runway, 160);
  EXPECT_FALSE(landing.height_above_runway_known);
}

TEST(RunwayReport, NothingJumpsWhereStereoTakesOver) {
  // 0.5 m between the two, down to the threshold.
  double before = kUnknown;
  for (double x = -1500; x < 0; x += 50) {
    LandingResult landing = stereoAt(30);
    const TrackedPosition outline = outlineAt(x, 30.5, 0.4);
    handOver(outline, {}, landing);
    reportHeightAboveRunway(outline, 0, false, {}, landing);
    const double now = landing.height_above_runway;
    ASSERT_GE(now, 30 - 1e-9);
    ASSERT_LE(now, 30.5 + 1e-9);
    EXPECT_FALSE(landing.runway_failure);
    if (std::isfinite(before)) EXPECT_LT(std::abs(now - before), 0.2) << x;
    before = now;
  }
  EXPECT_LT(before, 30.35) << "stereo counts more and more";
}

TEST(RunwayReport, TheLevelOfTheEdgesCoversTheMeanWithTheOutline) {
  LandingResult landing;
  landing.y = 1;
  landing.y_variance = 0.25;
  landing.y_protection_level = 2.5;
  handOver(outlineAt(-1000, 60, 1), {}, landing);
  // The outline says 2 m with 1 sigma of 1 m: four times the variance, so a sixteenth of the weight.
  EXPECT_DOUBLE_EQ(landing.y, 1 + 1 / 17.0);
  EXPECT_NEAR(landing.y_variance, (16 * 16 * 0.25 + 1) / (17 * 17), 1e-12);
  EXPECT_DOUBLE_EQ(landing.y_protection_level, 2.5 + 1 / 17.0);
  LandingResult alone;
  handOver(outlineAt(-1000, 60, 1), {}, alone);
  EXPECT_EQ(alone.y, 2);
  EXPECT_TRUE(std::isnan(alone.y_protection_level));
}

TEST(RunwayReport, SaysWhereOutlineAndStereoContradictEachOther) {
  LandingResult landing = stereoAt(30);
  const TrackedPosition outline = outlineAt(-100, 36, 0.4);  // the ground slopes by 1 m at most there
  handOver(outline, {}, landing);
  reportHeightAboveRunway(outline, 0, false, {}, landing);
  EXPECT_EQ(landing.runway_failure.reason, Reason::kInconsistent);
  EXPECT_TRUE(std::isnan(landing.height_above_runway));
  EXPECT_FALSE(landing.height_above_runway_known);
  EXPECT_EQ(landing.height, 30) << "which keeps its meaning";
}

TEST(RunwayReport, NamesTheOriginOfTheHeight) {
  MeasuredHeight measured;
  LandingResult landing;
  EXPECT_EQ(originOf(measured, landing), HeightOrigin::kNone);
  landing.height = 20;
  landing.status = Status::kTracking;
  EXPECT_EQ(originOf(measured, landing), HeightOrigin::kStereo);
  measured.by_width = true;
  EXPECT_EQ(originOf(measured, landing), HeightOrigin::kWidth);
  landing.status = Status::kCoasting;
  EXPECT_EQ(originOf(measured, landing), HeightOrigin::kPrediction);
}

}  // namespace
}  // namespace uav_landing
