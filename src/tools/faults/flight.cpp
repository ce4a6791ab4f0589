#include "faults/flight.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera_info.h"
#include "datasets/dataset.h"
#include "simulation/random_approach.h"
#include "simulator/ground/ground_profile.h"
#include "uav_landing/simulator/attitude.h"

namespace uav_landing {
namespace {

/// Time from which on the ground below was in view before, by a whole matching window. A change before that
/// time changes no pixel at the start of a run.
double timeOfKnownGround(const Flight& flight, const GroundProfile& profile) {
  constexpr int kMargin = 8;  // px
  const Flight::Frame& first = flight.frames.front();
  const SimulatedCamera& camera = flight.rig->left;
  const int row = first.left.rows - 1 - kMargin;
  const PixelRay& ray = camera.rays[static_cast<size_t>(row) * first.left.cols + first.left.cols / 2];
  const Eigen::Vector3d direction = runwayFromOptical(first.pose.attitude) * Eigen::Vector3d(ray.x, ray.y, 1);
  const Eigen::Vector3d& centre = first.pose.position;
  const GroundProfile::Line ground = profile.seen(centre, direction);
  const double way = (centre.z() - ground.at(centre.x())) / (ground.slope * direction.x() - direction.z());
  const double nearest = centre.x() + way * direction.x();
  const auto above = std::find_if(flight.frames.begin(), flight.frames.end(),
                                  [&](const Flight::Frame& f) { return f.pose.position.x() >= nearest; });
  return (above == flight.frames.end() ? flight.frames.back() : *above).time - first.time;
}

/// A time between two frames.
struct Moment {
  const Flight::Frame &before, &after;
  double share;  ///< of the way from the one to the other

  double operator()(double Truth::*value) const {
    return before.truth.*value + share * (after.truth.*value - before.truth.*value);
  }
};

Moment momentAt(const Flight& flight, double time) {
  const auto& frames = flight.frames;
  size_t next = 1;
  while (next + 1 < frames.size() && frames[next].time < time) ++next;
  const Flight::Frame &a = frames[next - 1], &b = frames[next];
  return {a, b, (time - a.time) / (b.time - a.time)};
}

}  // namespace

SimulatedFlight::SimulatedFlight(const ApproachSimulator& simulator, const SimulatorParameters& parameters)
    : rig(simulator.rig()) {
  const GroundProfile profile(parameters.profile);
  flight.runway_width = parameters.runway.width;
  flight.runway_is_level = profile.height(0) == 0 && profile.height(parameters.runway.length) == 0;
  flight.left = rig.left.calibration;
  flight.right = rig.right.calibration;
  flight.rig = &rig;
  for (int i = 0; i < simulator.frames(); ++i) {
    ApproachSimulator::Frame frame = simulator.frame(i);
    flight.frames.push_back({frame.time, frame.left, frame.right, frame.truth, simulator.pose(frame.time)});
  }
  if (!profile.flat()) flight.settled = std::max(flight.settled, timeOfKnownGround(flight, profile));
}

SimulatorParameters drawFlight(uint64_t seed, int frames, const Parameters& parameters,
                               const SceneryKind* scenery) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 1);
  // Height at the end of the run. From higher up most healthy frames would be too uncertain to be valid, so a
  // fault could not mislead.
  const double lowest = scenery == nullptr ? 3 : 8;
  const double height = lowest * std::pow(4.0, random.uniform(0.0, 1.0));
  SimulatorParameters p = drawSnippet(seed * 1000003, height, frames, parameters);
  p.setPictures(320, 240, 277.13);
  p.rig.x = 2;
  if (scenery != nullptr) drawScenery(*scenery, seed, p);
  return p;
}

SimulatorParameters drawThresholdFlight(uint64_t seed, int frames, const Parameters& parameters) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 2);
  SimulatorParameters p = drawSnippet(seed * 1000003, random.uniform(4.0, 8.0), frames, parameters);
  const double way = p.path.speed * std::cos(p.path.glide_angle_deg * M_PI / 180) * p.path.duration;
  p.path.start_x = -way * random.uniform(0.5, 0.8);
  return p;
}

std::unique_ptr<SimulatedFlight> simulateFlight(const SimulatorParameters& drawn) {
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(drawn);
  if (!simulator) return nullptr;
  return std::make_unique<SimulatedFlight>(*simulator, drawn);
}

Flight readFlight(const std::string& folder) {
  const Expected<Dataset> dataset = readDataset(folder);
  if (!dataset) throw std::runtime_error(dataset.error().detail);
  Flight flight;
  flight.left = toCalibration(dataset->left);
  flight.right = toCalibration(dataset->right);
  for (const DatasetFrame& frame : dataset->frames) {
    const auto left = readImage(frame.left, flight.left.imageSize());
    const auto right = readImage(frame.right, flight.right.imageSize());
    if (!left || !right) throw std::runtime_error((left ? right : left).error().detail);
    const double time = (frame.stamp - dataset->frames.front().stamp).toSec();
    flight.frames.push_back({time, *left, *right, frame.truth, {}});
  }
  return flight;
}

Flight cutFlight(const Flight& whole, int first, int frames) {
  Flight part{whole.left, whole.right, whole.rig, {}, 1.0, whole.runway_width, whole.runway_is_level};
  const auto begin = whole.frames.begin() + first;
  part.frames.assign(begin, begin + frames);
  return part;
}

FaultTruth truthAt(const Flight& flight, double time) {
  const Moment at = momentAt(flight, time);
  FaultTruth truth;
  truth.height = at(&Truth::height);
  truth.angle = at(&Truth::approach_angle);
  truth.yaw = at(&Truth::yaw);
  truth.x = at(&Truth::x);
  truth.y = at(&Truth::y);
  truth.speed = at(&Truth::speed);
  truth.runway_width = flight.runway_width;
  if (flight.rig == nullptr) return truth;
  const Eigen::Vector3d way = at.after.pose.position - at.before.pose.position;
  truth.velocity =
      runwayFromOptical(at.after.pose.attitude).transpose() * way / (at.after.time - at.before.time);
  if (flight.runway_is_level) truth.height_above_runway = at.before.pose.position.z() + at.share * way.z();
  return truth;
}

}  // namespace uav_landing
