#include "simulation/random_approach.h"

#include <algorithm>
#include <cmath>

#include "rig/rig_rotation.h"
#include "simulation/draw.h"
#include "simulator/ground/ground_profile.h"
#include "stereo/surface/surface_profile.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kRate = 20;  // Hz

void drawSensors(Draw& draw, SimulatorParameters& p) {
  p.image.blur = draw.uniform(0.4, 0.9);
  p.right_camera.gain = draw.uniform(0.92, 1.08);
  p.right_camera.offset = draw.uniform(-6, 6);
}

void drawCalibration(Draw& draw, const CalibrationPrior& prior, SimulatorParameters& p) {
  p.rig.stretch = draw.normal(prior.baseline);
  p.rig.bend_rx_deg = draw.normal(prior.rx) / kDegree;
  p.rig.bend_ry_deg = draw.normal(prior.ry) / kDegree;
  p.rig.bend_rz_deg = draw.normal(prior.rz) / kDegree;
}

void drawLens(Draw& draw, const CalibrationPrior& prior, SimulatedRigParameters& rig) {
  rig.lens_rows = draw.normal(prior.lens_rows);
  rig.lens_tilt_deg = draw.normal(prior.lens_tilt) / kDegree;
}

void drawImu(Draw& draw, const CalibrationPrior& prior, SimulatedImuParameters& imu) {
  imu.rate = 100;
  imu.pitch_error_deg = draw.normal(prior.imu_attitude) / kDegree;
  imu.roll_error_deg = draw.normal(prior.imu_attitude) / kDegree;
  imu.gyro_bias_x_deg = draw.normal(prior.imu_rate_bias) / kDegree;
  imu.gyro_bias_y_deg = draw.normal(prior.imu_rate_bias) / kDegree;
  imu.gyro_bias_z_deg = draw.normal(prior.imu_rate_bias) / kDegree;
  imu.gyro_noise_deg = prior.imu_rate / kDegree;
}

void drawRunway(Draw& draw, SimulatedRunwayParameters& runway) {
  runway.width = draw.scale(18, 60);
  runway.length = draw.uniform(800, 2500);
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

/// Everything but the start of the path and its length.
SimulatorParameters drawFlight(Draw& draw) {
  SimulatorParameters p;
  p.random.seed = draw.seed();
  drawSensors(draw, p);
  drawRunway(draw, p.runway);
  drawSurface(draw, p.surface);
  drawWobble(draw, p.wobble);
  p.path.rate = kRate;
  p.path.glide_angle_deg = draw.uniform(2.2, 6.0);
  p.path.speed = draw.uniform(15, 30);
  p.path.pitch_deg = draw.uniform(-7.5, -0.5);
  p.path.roll_deg = draw.uniform(-1, 1) * (8 - p.wobble.roll_deg);
  p.path.yaw_deg = draw.uniform(-1, 1) * (10 - p.wobble.yaw_deg);
  p.path.track_deg = draw.uniform(-1, 1);
  p.path.flare_height = 0;
  return p;
}

/// Puts the aircraft on its glide to a point beyond the threshold, at this height.
void place(double height, double touchdown, double y, SimulatedPathParameters& path) {
  path.start_height = height;
  path.start_x = touchdown - height / std::tan(path.glide_angle_deg * kDegree);
  path.start_y = y;
}

}  // namespace

CalibrationPrior calibrationPrior(const Parameters& parameters, double focal_length) {
  CalibrationPrior prior;
  // The simulator's ground is flat here, so an error of the baseline stands for all errors of the height.
  prior.baseline = parameters.kalman_height.height_model_error;
  prior.rx = prior.ry = prior.rz = parameters.stereo_depth.disparity_bias_stddev / focal_length;
  prior.lens_rows = parameters.stereo_depth.row_bias_stddev;
  prior.lens_tilt = prior.lens_rows / (kLensReach * focal_length);
  const ApproachAngleParameters& imu = parameters.approach_angle;
  prior.imu_attitude = std::hypot(imu.imu_attitude_stddev_deg, imu.runway_slope_stddev_deg) * kDegree;
  prior.imu_rate_bias = imu.imu_rate_bias_deg * kDegree;
  prior.imu_rate = imu.imu_rate_stddev_deg * kDegree;
  return prior;
}

SimulatorParameters drawSnippet(uint64_t seed, double height, int frames, const Parameters& parameters,
                                bool imu) {
  Draw draw(seed);
  SimulatorParameters p = drawFlight(draw);
  const CalibrationPrior prior = calibrationPrior(parameters, p.left_camera.fx);
  drawCalibration(draw, prior, p);
  p.path.duration = (frames - 1) / kRate;
  const double sink = p.path.speed * std::sin(p.path.glide_angle_deg * kDegree);
  const double y = draw.uniform(-0.35, 0.35) * p.runway.width;
  place(height + sink * p.path.duration, draw.uniform(0, 400), y, p.path);
  Draw lens(hashed(seed));  // separate, so that everything else is the same with it
  drawLens(lens, prior, p.rig);
  if (imu) drawImu(draw, prior, p.imu);
  return p;
}

void bendGround(uint64_t seed, const Parameters& parameters, SimulatorParameters& snippet) {
  constexpr double kLength = 100;               // m, that slope_change_deg refers to
  constexpr double kBefore = 100, kSeen = 200;  // m around the aircraft within which the change begins
  Draw draw(~seed);
  const double chance = draw.uniform(0, 1);
  const SimulatedPathParameters& path = snippet.path;
  const double glide = path.glide_angle_deg * kDegree;
  const double end = path.start_x + path.speed * std::cos(glide) * path.duration;
  const double begin = end + draw.uniform(-kBefore, kSeen), share = draw.uniform(0, 1);
  const double change = draw.normal(parameters.stereo_depth.slope_change_deg);
  const auto kind = static_cast<size_t>(chance / kBendChance);
  if (kind >= kBendShares.size()) return;
  snippet.profile.change_start = begin;
  snippet.profile.change_length = kLength;
  snippet.profile.slope_before_deg = -share * kBendShares[kind] * change;
  snippet.profile.slope_after_deg = (1 - share) * kBendShares[kind] * change;
  snippet.path.start_height += GroundProfile(snippet.profile).height(end);
}

SimulatorParameters drawApproach(uint64_t seed, const Parameters& parameters, bool imu) {
  Draw draw(seed);
  SimulatorParameters p = drawFlight(draw);
  constexpr double kStart = 60;  // m
  const double sink = p.path.speed * std::sin(p.path.glide_angle_deg * kDegree);
  p.path.flare_duration = 3;
  // In the flare it descends a little more than half as far as without it, and ends in level flight.
  p.path.flare_height = 0.6 * p.path.flare_duration * sink + draw.uniform(1.5, 4);
  p.path.flare_angle_deg = draw.uniform(0.3, 1.0);
  p.path.flare_pitch_deg = draw.uniform(0, 3);
  if (draw.chance(0.5)) {
    p.gust.speed = draw.uniform(-2, 2);
    p.gust.duration = draw.uniform(1, 2.5);
    p.gust.start = draw.uniform(0.2, 0.8) * (kStart - p.path.flare_height) / sink;
    // The gust leaves the aircraft lower by this amount, so that it flares at the same true height.
    p.path.flare_height += 0.5 * p.gust.speed * p.gust.duration;
  }
  p.path.duration = (kStart - p.path.flare_height) / sink + p.path.flare_duration;
  place(kStart, draw.uniform(150, 400), draw.uniform(-0.2, 0.2) * p.runway.width, p.path);
  p.path.track_deg *= 0.2;
  if (imu) drawImu(draw, calibrationPrior(parameters, p.left_camera.fx), p.imu);
  return p;
}

}  // namespace uav_landing
