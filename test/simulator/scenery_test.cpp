#include "simulator/ground/scenery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "simulator/lens.h"

namespace uav_landing {
namespace {

/// A square of ground with sides along the runway frame's axes.
GroundFootprint square(double x, double y, double side = 0.1) {
  return {static_cast<float>(x),
          static_cast<float>(y),
          {static_cast<float>(side), 0},
          {0, static_cast<float>(side)}};
}

/// Scenery with these elements on ground without texture.
Scenery sceneryOf(const SimulatedSceneryParameters& p, uint64_t seed = 1) {
  SimulatedSurfaceParameters surface;
  surface.runway_contrast = surface.grass_contrast = 0;
  return {p, {}, surface, seed};
}

constexpr float kBare = -1;
/// Grey level of a small piece of ground; kBare where there is no scenery.
float greyAt(const Scenery& scenery, double x, double y) {
  const Scenery::Shown shown = scenery.shown(square(x, y));
  return shown.bare == 1 ? kBare : shown.grey;
}

SimulatedSceneryParameters withTaxiway() {
  SimulatedSceneryParameters p;
  p.taxiway.x = 500;
  p.taxiway.y = -160;
  p.taxiway.length = 1000;
  p.taxiway.width = 20;
  p.taxiway.brightness = 80;
  p.taxiway.contrast = 0;
  return p;
}

SimulatedSceneryParameters withRoad() {
  SimulatedSceneryParameters p;
  p.road.x = 100;
  p.road.y = 50;
  p.road.direction_deg = 30;
  p.road.length = 400;
  p.road.width = 8;
  p.road.brightness = 60;
  p.road.contrast = 0;
  p.road.edge_line_width = 0.4;  // 0.3 m from the edge
  p.road.centre_line_width = 0.4;
  p.road.line_brightness = 200;
  return p;
}

SimulatedSceneryParameters withCrossing() {
  SimulatedSceneryParameters p;
  p.crossing_runway.x = 500;
  p.crossing_runway.direction_deg = 90;
  p.crossing_runway.length = 800;
  p.crossing_runway.width = 30;
  return p;
}

SimulatedSceneryParameters withRiver(double wave) {
  SimulatedSceneryParameters p;
  p.river.x = -300;
  p.river.direction_deg = -90;  // to the right; its left is the landing direction
  p.river.width = 40;
  p.river.wave = wave;
  p.river.wave_length = 500;
  p.river.contrast = 0;
  p.river.beach_width = 5;
  return p;
}

SimulatedSceneryParameters withTown() {
  SimulatedSceneryParameters p;
  p.town.length = 560;
  p.town.width = 265;
  p.town.block_length = 130;
  p.town.block_width = 43;
  p.town.street_width = 10;
  p.town.contrast = 0;
  return p;
}

/// A town with a roof of 100 grey levels on each plot, and nothing else.
SimulatedSceneryParameters withRoofsAlone() {
  SimulatedSceneryParameters p = withTown();
  p.town.street_brightness = p.town.garden_brightness = 0;
  p.town.roof_brightness = 100;
  p.town.roof_spread = 0;
  p.town.built = 1;
  return p;
}

SimulatedSceneryParameters withFields() {
  SimulatedSceneryParameters p;
  p.fields.x = 200;
  p.fields.direction_deg = 20;
  p.fields.length = 1200;
  p.fields.width = 600;
  p.fields.contrast = 0;
  p.fields.row_contrast = 0;
  return p;
}

TEST(Scenery, IsNotThereByDefault) {
  const Scenery scenery = sceneryOf({});
  EXPECT_TRUE(scenery.empty());
  EXPECT_EQ(greyAt(scenery, 100, 0), kBare);
}

TEST(Scenery, ATaxiwayLiesBetweenItsEdgesAndItsEnds) {
  const Scenery scenery = sceneryOf(withTaxiway());
  for (const double y : {-169.9, -160.0, -150.1})
    for (const double x : {0.1, 999.9}) EXPECT_EQ(greyAt(scenery, x, y), 80) << x << ", " << y;
  for (const double y : {-170.1, -149.9}) EXPECT_EQ(greyAt(scenery, 500, y), kBare) << y;
  for (const double x : {-0.1, 1000.1}) EXPECT_EQ(greyAt(scenery, x, -160), kBare) << x;
  // A quarter of a piece of 4 m lies beyond the edge.
  EXPECT_NEAR(scenery.shown(square(500, -151, 4)).bare, 0.25, 1e-5);
}

TEST(Scenery, ARoadFollowsItsDirectionAndHasLines) {
  const Scenery scenery = sceneryOf(withRoad());
  const double c = std::cos(30 * kDegree), s = std::sin(30 * kDegree);
  const auto at = [&](double along, double across) {
    return greyAt(scenery, 100 + along * c - across * s, 50 + along * s + across * c);
  };
  for (const double along : {-199.0, 3.0, 199.0}) {
    EXPECT_EQ(at(along, 2), 60);
    EXPECT_EQ(at(along, -3.5), 200) << "its edge line";
    EXPECT_EQ(at(along, 3.5), 200);
    EXPECT_EQ(at(along, 4.2), kBare);
    EXPECT_EQ(at(along, -4.2), kBare);
  }
  EXPECT_EQ(at(-200.2, 2), kBare);
  // Dashes of 6 m with gaps of 6 m from its beginning on.
  EXPECT_NEAR(at(-200 + 3, 0), 200, 1e-3);
  EXPECT_NEAR(at(-200 + 9, 0), 60, 1e-3);
  EXPECT_NEAR(at(-200 + 15, 0), 200, 1e-3);
}

TEST(Scenery, ALongFootprintBesideASlantedEdgeIsNotMixed) {
  // 40 m long and 1 m wide in the direction of the road, 1 m within its edge line: a box along the axes of
  // the runway frame would reach far beyond the road.
  const Scenery scenery = sceneryOf(withRoad());
  const auto c = static_cast<float>(std::cos(30 * kDegree)), s = static_cast<float>(std::sin(30 * kDegree));
  const GroundFootprint along{100 - 2 * s, 50 + 2 * c, {40 * c, 40 * s}, {-1 * s, 1 * c}};
  EXPECT_EQ(scenery.shown(along).bare, 0);
  EXPECT_EQ(scenery.shown(along).grey, 60);
  EXPECT_TRUE(scenery.even(along));
}

TEST(Scenery, ACrossingRunwayHasSurfaceAndMarksOfTheMainOne) {
  const Scenery scenery = sceneryOf(withCrossing());
  // To the left from (500, -400): its centre line has dashes of 30 m every 50 m from 60 m on.
  EXPECT_EQ(greyAt(scenery, 500, -400 + 70), 205);
  EXPECT_EQ(greyAt(scenery, 500, -400 + 100), 70);
  EXPECT_EQ(greyAt(scenery, 514.9, 10), 70);
  EXPECT_EQ(greyAt(scenery, 515.1, 10), kBare);
  EXPECT_EQ(greyAt(scenery, 500, -400.1), kBare);
  // Edge lines from 13.6 to 14.5 m; bars of 1.75 m with gaps of 1.75 m from 1.75 m on, the last one that has
  // room between the edge lines is the third: from 8.75 to 10.5 m.
  EXPECT_EQ(greyAt(scenery, 514, 10), 205);
  EXPECT_EQ(greyAt(scenery, 509.6, -380), 205);
  EXPECT_EQ(greyAt(scenery, 513.1, -380), 70);
}

TEST(Scenery, ARiverLiesToTheLeftOfItsNearBankAndHasSandOnBothSides) {
  const Scenery scenery = sceneryOf(withRiver(0));
  for (const double y : {-3000.0, 0.0, 700.0}) {
    EXPECT_EQ(greyAt(scenery, -299.9, y), 60) << y;
    EXPECT_EQ(greyAt(scenery, -260.1, y), 60) << y;
    EXPECT_EQ(greyAt(scenery, -300.1, y), 150) << y;
    EXPECT_EQ(greyAt(scenery, -304.9, y), 150) << y;
    EXPECT_EQ(greyAt(scenery, -259.9, y), 150) << y;
    EXPECT_EQ(greyAt(scenery, -305.1, y), kBare) << y;
    EXPECT_EQ(greyAt(scenery, -254.9, y), kBare) << y;
  }
}

TEST(Scenery, BanksSwingByTheirWaveToBothSides) {
  const Scenery scenery = sceneryOf(withRiver(15));
  double nearest = 0, farthest = -1000, sum = 0;
  constexpr int kSteps = 500;
  for (int i = 0; i < kSteps; ++i) {
    const double y = -20.0 * i;  // 20 waves
    double bank = -330;
    while (greyAt(scenery, bank, y) != 60) bank += 0.1;
    nearest = std::min(nearest, bank);
    farthest = std::max(farthest, bank);
    sum += bank;
  }
  EXPECT_GT(nearest, -315.2);
  EXPECT_LT(farthest, -284.8);
  EXPECT_GT(farthest - nearest, 20);
  EXPECT_NEAR(sum / kSteps, -300, 1);
}

TEST(Scenery, StreetsOfATownAreAGridFromItsCornerOn) {
  const Scenery scenery = sceneryOf(withTown());
  // 560 m by 265 m around (0, 0): streets of 10 m every 140 m and every 53 m.
  for (const double x : {-279.9, -270.1, -139.9, -130.1, 0.1, 9.9}) EXPECT_EQ(greyAt(scenery, x, 0), 60) << x;
  for (const double y : {-132.4, -122.6, -79.4, -69.6}) EXPECT_EQ(greyAt(scenery, -200, y), 60) << y;
  EXPECT_EQ(greyAt(scenery, -280.1, 0), kBare);
  EXPECT_EQ(greyAt(scenery, 280.1, 0), kBare);
  EXPECT_EQ(greyAt(scenery, 0, 132.6), kBare);
  // Just behind the street a garden begins, as roofs keep a distance of their own.
  EXPECT_EQ(greyAt(scenery, -200, -122.4), 100);
}

TEST(Scenery, AsManyPlotsAreBuiltOnAsAsked) {
  SimulatedSceneryParameters p = withRoofsAlone();
  const double all = sceneryOf(p).shown(square(0, 0, 260)).grey;
  p.town.length = p.town.width = 2000;  // some hundreds of plots
  p.town.built = 0.5;
  const double half = sceneryOf(p).shown(square(0, 0, 1800)).grey;
  p.town.built = 0;
  EXPECT_EQ(sceneryOf(p).shown(square(0, 0, 260)).grey, 0);
  // Blocks are 130/140 x 43/53 of the ground, roofs from 0.45 to 0.8 of a plot's sides: 0.39 of it on
  // average.
  EXPECT_NEAR(all, 100 * 130 * 43 / (140.0 * 53) * 0.625 * 0.625, 3.5);
  EXPECT_NEAR(half, 0.5 * 100 * 130 * 43 / (140.0 * 53) * 0.625 * 0.625, 2);
}

TEST(Scenery, TheTwoHalvesOfARoofLieSideBySide) {
  const Scenery scenery = sceneryOf(withRoofsAlone());
  // One half is up to 20 % brighter, the other one as much darker. Nowhere are there two roofs or a gap
  // within one: along a line across, a roof is one piece of at least 0.45 of a plot.
  int roofs = 0;
  for (double x = -260; x < -140; x += 1.5) {
    double begun = -1e9;
    for (double y = -132; y < 132; y += 0.5) {
      const float grey = greyAt(scenery, x, y);
      ASSERT_LE(grey, 120.1f) << x << ", " << y;
      if (grey > 0 && begun < -1e8) begun = y;
      if (grey > 0 || begun < -1e8) continue;
      EXPECT_GT(y - begun, 6) << x << ", " << y;
      begun = -1e9;
      ++roofs;
    }
  }
  EXPECT_GT(roofs, 100);
}

TEST(Scenery, FieldsFillTheirRectangleAndDifferByTheirSpread) {
  const SimulatedSceneryParameters p = withFields();
  const Scenery scenery = sceneryOf(p);
  const double c = std::cos(20 * kDegree), s = std::sin(20 * kDegree);
  std::set<float> greys;
  double border = 0, all = 0;
  for (double along = -595; along < 600; along += 2) {
    for (double across = -295; across < 300; across += 2) {
      const float grey = greyAt(scenery, 200 + along * c - across * s, along * s + across * c);
      ASSERT_NE(grey, kBare) << along << ", " << across;
      all += 1;
      if (grey == 55) border += 1;
      if (grey == std::floor(grey)) continue;  // the border's
      ASSERT_GE(grey, 60) << "55 is the border's";
      ASSERT_LE(grey, 140);
      greys.insert(std::round(grey * 10));
    }
  }
  // 1200 m x 600 m of fields of 250 m x 120 m: about 25; borders of 4 m take 4/250 + 4/120 of them.
  EXPECT_GE(greys.size(), 12u);
  EXPECT_GT(*greys.rbegin() - *greys.begin(), 300) << "tenths of a grey level";
  EXPECT_NEAR(border / all, 0.05, 0.015);
  EXPECT_EQ(greyAt(scenery, 200 + 601 * c, 601 * s), kBare);
  EXPECT_EQ(greyAt(scenery, 200 - 301 * s, 301 * c), kBare);
}

TEST(Scenery, CropRowsRepeatAtTheirSpacingAlongOneSideOfTheField) {
  SimulatedSceneryParameters p = withFields();
  p.fields.direction_deg = 0;
  p.fields.spread = 0;
  p.fields.row_contrast = 0.2;
  p.fields.row_spacing = 4;
  const Scenery scenery = sceneryOf(p);
  double largest = 0;
  int along_rows = 0, across_rows = 0;
  for (double x = -350; x < 750; x += 37) {
    for (double y = -250; y < 250; y += 31) {
      for (const bool along : {false, true}) {
        std::vector<float> walk;  // one spacing in steps of a quarter of it
        for (int step = 0; step <= 4; ++step)
          walk.push_back(greyAt(scenery, x + (along ? step : 0), y + (along ? 0 : step)));
        const auto [low, high] = std::minmax_element(walk.begin(), walk.end());
        if (*low < 70) continue;  // a border
        if (*high - *low < 0.01) {
          ++along_rows;
          continue;
        }
        ++across_rows;
        EXPECT_NEAR(walk[4], walk[0], 0.1);
        EXPECT_NEAR(0.5 * (walk[0] + walk[2]), 105, 0.1);
        EXPECT_NEAR(0.5 * (walk[1] + walk[3]), 105, 0.1);
        largest = std::max<double>(largest, std::hypot(walk[0] - 105, walk[1] - 105));
      }
    }
  }
  EXPECT_GT(across_rows, 100);
  EXPECT_NEAR(across_rows, along_rows, 30) << "one of the two walks crosses the rows";
  EXPECT_GT(largest, 0.15 * 105);
  EXPECT_LT(largest, 0.2 * 105 + 0.1);
}

TEST(Scenery, TheGrassStripHidesWhatIsBelowIt) {
  SimulatedSceneryParameters p = withTown();
  p.town.length = p.town.width = 1000;
  p.grass_strip.side = 30;
  p.grass_strip.end = 50;
  const Scenery scenery = sceneryOf(p);
  for (const double y : {-52.4, 0.0, 52.4}) EXPECT_EQ(greyAt(scenery, -49.9, y), 105) << "22.5 m + 30 m";
  EXPECT_NE(greyAt(scenery, -50.3, 0), 105);
  EXPECT_NE(greyAt(scenery, 100, 52.7), 105);
}

TEST(Scenery, LaterElementsLieOnTop) {
  SimulatedSceneryParameters p = withTaxiway();
  p.shore = withRiver(0).river;
  p.shore.x = 400;
  p.road = withRoad().road;
  p.road.x = 410;
  p.road.y = 0;
  p.road.direction_deg = 90;
  const Scenery scenery = sceneryOf(p);
  EXPECT_EQ(greyAt(scenery, 408, -160), 80) << "the taxiway over road and water";
  EXPECT_EQ(greyAt(scenery, 408, -140), 60) << "the road over water";
  EXPECT_EQ(greyAt(scenery, 420, -140), 60);
}

TEST(Scenery, SeedDrawsTownAndFields) {
  for (const SimulatedSceneryParameters& p : {withTown(), withFields()}) {
    const Scenery one = sceneryOf(p, 1), same = sceneryOf(p, 1), other = sceneryOf(p, 2);
    int different = 0;
    for (double x = -250; x < 250; x += 11) {
      ASSERT_EQ(greyAt(one, x, -40), greyAt(same, x, -40));
      different += greyAt(one, x, -40) != greyAt(other, x, -40) ? 1 : 0;
    }
    EXPECT_GT(different, 10);
  }
}

struct Element {
  const char* name;
  SimulatedSceneryParameters parameters;
};
void PrintTo(const Element& element, std::ostream* stream) { *stream << element.name; }

class SceneryElement : public testing::TestWithParam<Element> {
 protected:
  const Scenery scenery_ = sceneryOf(GetParam().parameters);
  /// Mean of what the parts of a rectangle show.
  static Scenery::Shown meanOf(const Scenery& scenery, const GroundPatch& patch, int parts) {
    Scenery::Shown mean{0, 0};
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < parts; ++j) {
        const Eigen::Vector2f u(patch.length / parts, 0), v(0, patch.width / parts);
        const Scenery::Shown part = scenery.shown({patch.x + (i + 0.5f) * u.x() - 0.5f * patch.length,
                                                   patch.y + (j + 0.5f) * v.y() - 0.5f * patch.width, u, v});
        mean.grey += part.grey / (parts * parts);
        mean.bare += part.bare / (parts * parts);
      }
    }
    return mean;
  }
};

TEST_P(SceneryElement, ShowsTheMeanOfAFootprintsParts) {
  cv::RNG random(5);
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    const GroundPatch patch{random.uniform(-350.0f, 650.0f), random.uniform(-200.0f, 200.0f),
                            random.uniform(1.0f, 60.0f), random.uniform(0.3f, 6.0f)};
    const Scenery::Shown whole = scenery_.shown({patch.x, patch.y, {patch.length, 0}, {0, patch.width}});
    const Scenery::Shown parts = meanOf(scenery_, patch, 40);
    // A slanted edge is taken for one along the box's sides: right in position and width.
    worst = std::max<double>(worst, std::abs(whole.grey - parts.grey));
    EXPECT_NEAR(whole.bare, parts.bare, 0.15) << patch.x << ", " << patch.y;
    EXPECT_NEAR(whole.grey, parts.grey, 12) << patch.x << ", " << patch.y;
  }
  EXPECT_LT(worst, 12) << "grey levels";
}

TEST_P(SceneryElement, WhatIsEvenIsOneMaterial) {
  int even = 0;
  for (double x = -350; x < 650; x += 13.7) {
    for (double y = -200; y < 200; y += 7.3) {
      const GroundFootprint footprint = square(x, y, 3);
      if (!scenery_.even(footprint)) continue;
      ++even;
      const Scenery::Shown whole = scenery_.shown(footprint);
      for (const double dx : {-1.45, 0.0, 1.45})
        for (const double dy : {-1.45, 0.0, 1.45})
          ASSERT_NEAR(scenery_.shown(square(x + dx, y + dy)).grey, whole.grey, 1e-3) << x << ", " << y;
    }
  }
  EXPECT_GT(even, 500);
}

INSTANTIATE_TEST_SUITE_P(, SceneryElement,
                         testing::Values(Element{"taxiway", withTaxiway()}, Element{"road", withRoad()},
                                         Element{"crossing_runway", withCrossing()},
                                         Element{"straight_river", withRiver(0)},
                                         Element{"river", withRiver(15)}, Element{"town", withTown()},
                                         Element{"fields", withFields()}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace uav_landing
