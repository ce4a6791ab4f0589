#include "simulator/ground/runway_surface.h"

#include <gtest/gtest.h>

#include <ostream>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

/// 1000 m x 40 m, with marks at round numbers.
SimulatedRunwayParameters marked() {
  SimulatedRunwayParameters p;
  p.length = 1000;
  p.width = 40;
  p.edge_line_width = 1;
  p.edge_line_inset = 2;  // from 17 to 18 m
  p.centre_line_width = 1;
  p.centre_dash_length = 30;
  p.centre_gap_length = 20;
  p.centre_line_start = 60;
  p.threshold_line_width = 2;
  p.threshold_bars = 2;
  p.threshold_bars_start = 10;
  p.threshold_bar_length = 30;
  p.threshold_centre_gap = 4;  // from 2 to 5 and from 6 to 9 m
  p.threshold_bar_width = 3;
  p.threshold_bar_gap = 1;
  p.aiming_point_distance = 300;
  p.aiming_point_length = 50;
  p.aiming_point_gap = 16;  // from 8 to 14 m
  p.aiming_point_width = 6;
  return p;
}

/// Share of paint in 10 cm x 10 cm of ground.
float paintAt(float x, float y) { return RunwaySurface(marked()).cover({x, y, 0.1f, 0.1f}).paint; }

struct Place {
  float x, y;
  bool painted;
  friend std::ostream& operator<<(std::ostream& out, const Place& place) {
    return out << place.x << ", " << place.y << (place.painted ? ", painted" : ", bare");
  }
};

class RunwayMarks : public testing::TestWithParam<Place> {};

TEST_P(RunwayMarks, AreOnBothSidesAndAtBothEnds) {
  const Place& place = GetParam();
  for (const float y : {place.y, -place.y})
    for (const float x : {place.x, 1000 - place.x})
      EXPECT_EQ(paintAt(x, y), place.painted ? 1 : 0) << "at " << x << ", " << y;
}

INSTANTIATE_TEST_SUITE_P(EdgeLines, RunwayMarks,
                         testing::Values(Place{450, 17.5f, true}, Place{450, 16.9f, false},
                                         Place{450, 18.1f, false}, Place{1, 17.5f, true}));
INSTANTIATE_TEST_SUITE_P(ThresholdLine, RunwayMarks,
                         testing::Values(Place{1, 12, true}, Place{1, 16.9f, true}, Place{2.1f, 12, false},
                                         Place{1, 18.1f, false}));
INSTANTIATE_TEST_SUITE_P(ThresholdBars, RunwayMarks,
                         testing::Values(Place{11, 1.9f, false}, Place{11, 2.1f, true}, Place{39, 4.9f, true},
                                         Place{25, 5.5f, false}, Place{25, 6.1f, true}, Place{25, 8.9f, true},
                                         Place{25, 9.1f, false}, Place{9.8f, 7, false},
                                         Place{40.2f, 7, false}));
INSTANTIATE_TEST_SUITE_P(AimingPoint, RunwayMarks,
                         testing::Values(Place{301, 7.9f, false}, Place{301, 8.1f, true},
                                         Place{349, 13.9f, true}, Place{325, 14.1f, false},
                                         Place{299, 10, false}, Place{351, 10, false}));
INSTANTIATE_TEST_SUITE_P(Bare, RunwayMarks, testing::Values(Place{450, 10, false}, Place{200, 3, false}));

TEST(RunwaySurface, CentreLineIsDashesOfItsLengthsBetweenItsEnds) {
  // 30 m of paint from 60 m on, 20 m without.
  for (const auto& [x, painted] : std::vector<std::pair<float, bool>>{
           {59, false}, {61, true}, {89, true}, {91, false}, {109, false}, {111, true}, {941, false}})
    for (const float y : {-0.4f, 0.0f, 0.4f}) EXPECT_NEAR(paintAt(x, y), painted ? 1 : 0, 1e-3) << x;
  EXPECT_NEAR(paintAt(70, 0.6f), 0, 1e-3);
}

TEST(RunwaySurface, ADisplacedThresholdHasSurfaceAndEdgeLinesBeforeItAndMarksBehindIt) {
  SimulatedRunwayParameters p = marked();
  p.displaced_threshold = 180;
  const RunwaySurface surface(p);
  const auto at = [&](float x, float y) { return surface.cover({x, y, 0.1f, 0.1f}); };
  for (const float x : {-179.9f, -1.0f, 1001.0f, 1179.9f}) {
    EXPECT_EQ(at(x, 10).runway, 1) << x;
    EXPECT_EQ(at(x, 10).paint, 0) << x;
    EXPECT_EQ(at(x, -17.5f).paint, 1) << x;
  }
  EXPECT_EQ(at(-180.1f, 0).runway, 0);
  EXPECT_EQ(at(1180.1f, 0).runway, 0);
  EXPECT_EQ(at(1, 12).paint, 1) << "threshold line";
  EXPECT_EQ(at(25, 7).paint, 1) << "bars";
  // Shafts of 25 m every 60 m, the last ends 5 m before the threshold.
  for (const auto& [x, painted] : std::vector<std::pair<float, bool>>{{-4, false},
                                                                      {-6, true},
                                                                      {-29, true},
                                                                      {-31, false},
                                                                      {-64, false},
                                                                      {-66, true},
                                                                      {-149, true},
                                                                      {-151, false}})
    for (const float there : {x, 1000 - x}) EXPECT_EQ(at(there, 0.2f).paint, painted ? 1 : 0) << there;
}

TEST(RunwaySurface, AreasAreExact) {
  const RunwaySurface surface(marked());
  // Across all of it, between marks: two edge lines of 1 m in 40 m.
  RunwaySurface::Cover cover = surface.cover({250, 3, 2, 60});
  EXPECT_NEAR(cover.runway, 40.0 / 60, 1e-6);
  // A dash begins at 260 m.
  EXPECT_NEAR(cover.paint, 2.0 / 60, 1e-6);
  // Half a patch beyond the threshold, a quarter of it beyond the side.
  cover = surface.cover({0, 19, 2, 4});
  EXPECT_NEAR(cover.runway, 0.5 * 0.75, 1e-6);
  // A period of the centre line, from a dash's beginning on: 30 of 50 m, and half of the patch is 1 m wide.
  EXPECT_NEAR(surface.cover({185, 0, 50, 2}).paint, 0.5 * 0.6, 1e-6);
  // Beside the runway there is none, and no paint.
  cover = surface.cover({-10, 0, 2, 2});
  EXPECT_EQ(cover.runway, 0);
  EXPECT_EQ(cover.paint, 0);
}

}  // namespace
}  // namespace uav_landing
