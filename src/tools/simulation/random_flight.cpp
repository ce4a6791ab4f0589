#include "simulation/random_flight.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

void drawSensors(Draw& draw, SimulatorParameters& p) {
  p.image.blur = draw.uniform(0.4, 0.9);
  p.right_camera.gain = draw.uniform(0.92, 1.08);
  p.right_camera.offset = draw.uniform(-6, 6);
}

void drawSurface(Draw& draw, SimulatedSurfaceParameters& surface) {
  surface.runway_brightness = draw.uniform(50, 115);
  surface.runway_contrast = draw.uniform(0.05, 0.15);
  surface.runway_grain = draw.scale(0.01, 0.04);
  surface.grass_brightness = draw.uniform(70, 130);
  surface.grass_contrast = draw.uniform(0.08, 0.2);
  surface.grass_grain = draw.scale(0.015, 0.06);
  surface.marking_brightness = draw.uniform(165, 225);
  surface.visibility = draw.scale(2000, 20000);
  surface.sky_horizon = draw.uniform(140, 200);
  surface.sky_zenith = draw.uniform(90, 140);
  surface.cloud_contrast = draw.uniform(0, 30);
}

void drawWobble(Draw& draw, SimulatedWobbleParameters& wobble) {
  wobble.roll_deg = draw.uniform(0, 3);
  wobble.roll_period = draw.scale(2.5, 8);
  wobble.pitch_deg = draw.uniform(0, 1);
  wobble.pitch_period = draw.scale(2, 6);
  wobble.yaw_deg = draw.uniform(0, 1.5);
  wobble.yaw_period = draw.scale(3, 8);
  wobble.sway = draw.uniform(0, 0.4);
  wobble.sway_period = draw.scale(5, 12);
  wobble.heave = draw.uniform(0, 0.1);
  wobble.heave_period = draw.scale(2.5, 8);
}

}  // namespace

void drawMarks(Draw& draw, SimulatedRunwayParameters& runway) {
  runway.edge_line_width = draw.chance(0.85) ? draw.uniform(0.45, 0.9) : 0;
  runway.edge_line_inset = draw.uniform(0.3, 1.5);
  runway.centre_line_width = draw.uniform(0.3, 0.9);
  runway.threshold_line_width = draw.chance(0.5) ? draw.uniform(0.9, 1.8) : 0;
  // Bars from the middle to a little inside of the edge lines.
  const double pitch = draw.uniform(3.0, 3.8);
  runway.threshold_bar_width = draw.uniform(0.45, 0.55) * pitch;
  runway.threshold_bar_gap = pitch - runway.threshold_bar_width;
  runway.threshold_centre_gap = 2 * runway.threshold_bar_gap;
  runway.threshold_bars = draw.chance(0.85) ? static_cast<int>((0.5 * runway.width - 3.5) / pitch) : 0;
  runway.aiming_point_distance = draw.uniform(150, 400);
  runway.aiming_point_length = draw.chance(0.7) ? draw.uniform(30, 60) : 0;
  runway.aiming_point_width = std::min(6.0, 0.12 * runway.width);
  runway.aiming_point_gap = 0.4 * runway.width;
  runway.tyre_marks = draw.uniform(0, 0.45);
}

SimulatorParameters drawFlight(Draw& draw) {
  SimulatorParameters p;
  p.random.seed = draw.seed();
  drawSensors(draw, p);
  p.runway.width = draw.scale(18, 60);
  p.runway.length = draw.uniform(800, 2500);
  drawMarks(draw, p.runway);
  drawSurface(draw, p.surface);
  drawWobble(draw, p.wobble);
  p.path.rate = kFlightRate;
  p.path.glide_angle_deg = draw.uniform(2.2, 6.0);
  p.path.speed = draw.uniform(15, 30);
  p.path.pitch_deg = draw.uniform(-7.5, -0.5);
  p.path.roll_deg = draw.uniform(-1, 1) * (8 - p.wobble.roll_deg);
  p.path.yaw_deg = draw.uniform(-1, 1) * (10 - p.wobble.yaw_deg);
  p.path.track_deg = draw.uniform(-1, 1);
  p.path.flare_height = 0;
  return p;
}

void place(double height, double touchdown, double y, SimulatedPathParameters& path) {
  path.start_height = height;
  path.start_x = touchdown - height / std::tan(path.glide_angle_deg * kDegree);
  path.start_y = y;
}

}  // namespace uav_landing
