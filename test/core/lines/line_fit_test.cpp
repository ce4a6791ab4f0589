#include "lines/segments/line_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing::line_fit {
namespace {

/// Mean squares of the errors over the variances that are claimed: 1 when these are true.
struct Ratios {
  double offset = 0, angle = 0;
};

/// Of lines through peaks with normal errors, each of which has this share of the one before it.
Ratios ratiosOfLines(double correlation) {
  constexpr int kLines = 2000, kPeaks = 150;
  constexpr double kStddev = 2;  // px, much more than the floor of what is claimed
  const Axis axis({20, 50}, {1, 0});
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, kStddev);
  Ratios ratios;
  for (int line = 0; line < kLines; ++line) {
    Peaks peaks;
    double error = normal(random);
    for (int i = 0; i < kPeaks; ++i) {
      peaks.add({static_cast<double>(i), error, 10});
      error = correlation * error + std::sqrt(1 - correlation * correlation) * normal(random);
    }
    double scale = 0;
    const Fit fit = fitRobustly(peaks, scale);
    const LineSegment segment = segmentOf(axis, peaks, fit, 1);
    const double offset = segment.middle().y() - 50;
    const double angle = std::atan2(segment.b.y() - segment.a.y(), segment.b.x() - segment.a.x());
    ratios.offset += std::pow(offset / segment.offset_stddev, 2) / kLines;
    ratios.angle += std::pow(angle / segment.angle_stddev, 2) / kLines;
  }
  return ratios;
}

TEST(LineFit, ClaimsVariancesThatAreTrue) {
  const Ratios ratios = ratiosOfLines(0);
  EXPECT_NEAR(ratios.offset, 1, 0.15);
  EXPECT_NEAR(ratios.angle, 1, 0.15);
}

// Without what neighbours have in common the ratio would be 3. The robust weights cut the largest errors, and
// with them some of what is in common: a quarter of the variance is missing.
TEST(LineFit, ClaimsVariancesThatAreTrueWhereARaggedEdgeIsRaggedOverSeveralStations) {
  const Ratios ratios = ratiosOfLines(0.5);
  EXPECT_NEAR(ratios.offset, 1, 0.4);
  EXPECT_NEAR(ratios.angle, 1, 0.4);
}

}  // namespace
}  // namespace uav_landing::line_fit
