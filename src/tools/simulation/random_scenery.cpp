#include <algorithm>
#include <cmath>

#include "simulation/draw.h"
#include "simulation/random_approach.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

void drawFields(Draw& draw, SimulatedFieldsParameters& fields) {
  fields.x = 1500;
  fields.length = 7000;
  fields.width = 4000;
  fields.direction_deg = draw.uniform(-90, 90);
  fields.field_length = draw.scale(120, 500);
  fields.field_width = draw.scale(50, 250);
  fields.brightness = draw.uniform(80, 130);
  fields.spread = draw.uniform(10, 50);
  fields.border_width = draw.uniform(0.5, 8);
  fields.border_brightness = draw.uniform(35, 160);
  fields.row_spacing = draw.scale(0.7, 6);
  fields.row_contrast = draw.uniform(0, 0.3);
}

void drawTown(Draw& draw, SimulatedTownParameters& town) {
  town.x = draw.uniform(-900, 300);
  town.y = draw.uniform(-400, 400);
  town.direction_deg = draw.uniform(-90, 90);
  town.length = draw.uniform(400, 2000);
  town.width = draw.uniform(300, 1200);
  town.block_length = draw.uniform(80, 200);
  town.block_width = draw.uniform(35, 80);
  town.street_width = draw.uniform(6, 18);
  town.plot = draw.uniform(15, 35);
  town.built = draw.uniform(0.4, 1);
  town.street_brightness = draw.uniform(45, 130);
  town.roof_brightness = draw.uniform(80, 150);
  town.roof_spread = draw.uniform(20, 80);
  town.garden_brightness = draw.uniform(70, 130);
}

void drawWater(Draw& draw, SimulatedWaterParameters& water) {
  water.wave = draw.uniform(0, 30);
  water.wave_length = draw.uniform(300, 1500);
  water.brightness = draw.uniform(35, 150);
  water.beach_width = draw.uniform(0, 20);
  water.beach_brightness = draw.uniform(100, 190);
}

/// Equally often on the left and on the right, between these distances.
double drawBothSides(Draw& draw, double from, double to) {
  const double side = draw.chance(0.5) ? 1 : -1;
  return side * draw.uniform(from, to);
}

void drawStrip(Draw& draw, SimulatedStripParameters& strip) {
  strip.brightness = draw.uniform(50, 150);
  strip.edge_line_width = draw.chance(0.6) ? draw.uniform(0.15, 0.4) : 0;
  strip.centre_line_width = draw.chance(0.7) ? draw.uniform(0.15, 0.4) : 0;
  strip.centre_gap_length = draw.chance(0.5) ? draw.uniform(3, 12) : 0;
}

void drawOwnFrame(Draw& draw, SimulatedOwnFrameParameters& frame) {
  if (draw.chance(0.7)) frame.nose_height = draw.uniform(0.05, 0.2);
  frame.nose_width = draw.uniform(0.3, 0.8);
  frame.nose_left = draw.uniform(0.3, 0.7);
  frame.nose_right = 1 - frame.nose_left;
  frame.nose_brightness = draw.uniform(20, 140);
  if (draw.chance(0.5)) frame.post_width = draw.uniform(0.01, 0.05);
  frame.post_left = draw.uniform(0.02, 0.2);
  frame.post_right = 1 - frame.post_left;
  frame.post_tilt_deg = draw.uniform(0, 25);
}

/// Chances of the elements.
struct Shares {
  double fields = 0.5, town = 0.3, grass_strip = 0.85, river = 0.25, shore = 0.25, road = 0.5, taxiway = 0.5,
         crossing_runway = 0.25, displaced_threshold = 0.3, own_frame = 0.2;

  static Shares certain() { return {1, 1, 1, 1, 1, 1, 1, 1, 0.3, 0}; }
};

/// Puts each element around the runway with its chance.
void drawElements(Draw& draw, const Shares& share, SimulatorParameters& flight) {
  SimulatedSceneryParameters& p = flight.scenery;
  const double half = 0.5 * flight.runway.width;
  if (draw.chance(share.fields)) drawFields(draw, p.fields);
  if (draw.chance(share.town)) drawTown(draw, p.town);
  if (draw.chance(share.grass_strip)) p.grass_strip.side = draw.uniform(20, 100);
  drawWater(draw, p.river);
  p.river.x = draw.uniform(-700, -50);
  p.river.direction_deg = -draw.uniform(30, 150);
  if (draw.chance(share.river)) p.river.width = draw.uniform(8, 60);
  drawWater(draw, p.shore);
  // Its water lies on its left, away from the runway.
  p.shore.y = drawBothSides(draw, half + 60, half + 300);
  p.shore.direction_deg = (p.shore.y > 0 ? 0 : 180) + draw.uniform(-15, 15);
  if (p.shore.direction_deg > 180) p.shore.direction_deg -= 360;
  if (draw.chance(share.shore)) p.shore.width = draw.scale(200, 30000);
  drawStrip(draw, p.road);
  p.road.x = draw.uniform(-400, 800);
  p.road.y = drawBothSides(draw, half + 60, half + 300);
  p.road.direction_deg = draw.uniform(-25, 25);
  p.road.length = draw.uniform(1000, 5000);
  if (draw.chance(share.road)) p.road.width = draw.uniform(5, 25);
  drawStrip(draw, p.taxiway);
  p.taxiway.x = 0.5 * flight.runway.length;
  p.taxiway.y = drawBothSides(draw, half + 40, half + 200);
  p.taxiway.length = flight.runway.length + draw.uniform(-200, 400);
  if (draw.chance(share.taxiway)) p.taxiway.width = draw.uniform(10, 30);
  p.crossing_runway.x = draw.uniform(-100, flight.runway.length);
  p.crossing_runway.y = draw.uniform(-200, 200);
  p.crossing_runway.direction_deg = drawBothSides(draw, 20, 90);
  p.crossing_runway.length = draw.uniform(600, 2500);
  if (draw.chance(share.crossing_runway)) p.crossing_runway.width = draw.uniform(18, 60);
  if (draw.chance(share.displaced_threshold)) flight.runway.displaced_threshold = draw.uniform(40, 300);
  if (draw.chance(share.own_frame)) drawOwnFrame(draw, p.own_frame);
}

/// Puts a hill before the threshold. It is at most half as high as the flight over its top.
void drawHill(Draw& draw, SimulatorParameters& flight) {
  SimulatedProfileParameters& profile = flight.profile;
  const SimulatedPathParameters& path = flight.path;
  profile.hill_length = draw.uniform(150, 500);
  profile.hill_x = -0.5 * profile.hill_length - draw.uniform(0, 200);
  const double above = path.start_height - std::tan(path.glide_angle_deg * kDegree) *
                                               std::max(0.0, profile.hill_x - path.start_x);
  profile.hill_height = std::min(draw.uniform(3, 15), 0.5 * above);
}

/// Keeps the elements that belong to such a landscape.
void keepElements(SceneryKind kind, SimulatedSceneryParameters& all) {
  SimulatedSceneryParameters kept;
  kept.grass_strip = all.grass_strip;
  if (kind == SceneryKind::kTown) kept.town = all.town;
  if (kind == SceneryKind::kFields || kind == SceneryKind::kHills) kept.fields = all.fields;
  if (kind == SceneryKind::kTown || kind == SceneryKind::kFields || kind == SceneryKind::kAirport)
    kept.road = all.road;
  if (kind == SceneryKind::kShore) {
    kept.shore = all.shore;
    kept.river = all.river;
  }
  if (kind == SceneryKind::kAirport) {
    kept.taxiway = all.taxiway;
    kept.crossing_runway = all.crossing_runway;
  }
  all = kept;
}

}  // namespace

const std::map<std::string, SceneryKind>& sceneryKinds() {
  static const std::map<std::string, SceneryKind> kinds{
      {"random", SceneryKind::kRandom}, {"town", SceneryKind::kTown},       {"fields", SceneryKind::kFields},
      {"shore", SceneryKind::kShore},   {"airport", SceneryKind::kAirport}, {"hills", SceneryKind::kHills}};
  return kinds;
}

void drawScenery(uint64_t seed, SimulatorParameters& flight) {
  drawScenery(SceneryKind::kRandom, seed, flight);
}

void drawScenery(SceneryKind kind, uint64_t seed, SimulatorParameters& flight) {
  Draw draw(hashed(~seed));  // separate, so that everything else is the same with it
  const bool random = kind == SceneryKind::kRandom;
  drawElements(draw, random ? Shares() : Shares::certain(), flight);
  if (!random) keepElements(kind, flight.scenery);
  if (kind == SceneryKind::kHills) drawHill(draw, flight);
}

}  // namespace uav_landing
