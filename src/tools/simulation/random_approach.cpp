#include "simulation/random_approach.h"

#include <algorithm>
#include <cmath>

#include "rig/rig_rotation.h"
#include "simulation/draw.h"
#include "simulation/random_flight.h"
#include "simulator/ground/ground_profile.h"
#include "stereo/surface/surface_profile.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

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
  p.path.duration = (frames - 1) / kFlightRate;
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
