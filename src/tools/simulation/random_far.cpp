#include <algorithm>
#include <cmath>

#include "simulation/draw.h"
#include "simulation/random_approach.h"
#include "simulation/random_flight.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kRate = 10;                                             // Hz
constexpr double kEndHeight = 20;                                        // m
constexpr double kNarrow = 18, kBroad = 60, kShort = 600, kLong = 4000;  // m

/// Broad runways are mostly long ones.
void drawSize(Draw& draw, SimulatedRunwayParameters& runway) {
  runway.width = draw.scale(kNarrow, kBroad);
  const double breadth = std::log(runway.width / kNarrow) / std::log(kBroad / kNarrow);
  const double usual = kShort * std::pow(kLong / kShort, breadth);
  runway.length = std::clamp(usual * draw.scale(0.7, 1.4), kShort, kLong);
}

}  // namespace

SimulatorParameters drawFarApproach(uint64_t seed) {
  Draw draw(seed);
  SimulatorParameters p = drawFlight(draw);
  drawSize(draw, p.runway);
  drawMarks(draw, p.runway);
  p.surface.visibility = draw.scale(6000, 40000);
  p.path.rate = kRate;
  p.path.speed = draw.uniform(35, 75);
  p.path.glide_angle_deg = draw.uniform(2.5, 4);
  p.path.pitch_deg = draw.uniform(-5, -1);
  p.path.track_deg = draw.uniform(-0.5, 0.5);
  const double distance = draw.uniform(3000, 5000), touchdown = draw.uniform(250, 400);
  const double glide = p.path.glide_angle_deg * kDegree;
  const double height = (distance + touchdown) * std::tan(glide);
  const double aside = draw.uniform(-0.3, 0.3) * p.runway.width;  // at the threshold
  place(height, touchdown, aside - distance * std::tan(p.path.track_deg * kDegree), p.path);
  p.path.duration = (height - kEndHeight) / (p.path.speed * std::sin(glide));
  if (draw.chance(0.25)) drawScenery(SceneryKind::kHills, seed, p);
  return p;
}

}  // namespace uav_landing
