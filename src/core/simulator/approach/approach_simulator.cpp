#include "uav_landing/simulator/approach_simulator.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "simulator/approach/own_frame.h"
#include "simulator/approach/renderer.h"
#include "simulator/approach/rolling_shutter.h"
#include "simulator/approach/sensor.h"

namespace uav_landing {

namespace {

/// Moves objects from z = 0 to the height of the ground where they stand.
std::vector<StandingObject> standOn(const GroundProfile& ground, std::vector<StandingObject> objects) {
  for (StandingObject& object : objects) {
    const auto lift = static_cast<float>(ground.height(0.5 * (object.low.x() + object.high.x())));
    object.low.z() += lift;
    object.high.z() += lift;
  }
  return objects;
}

Failure checkReadout(const SimulatorParameters& p) {
  const double longest = 1 / p.path.rate, given = std::abs(p.image.readout_time);
  if (given <= longest * (1 + 1e-9)) return {};
  std::ostringstream detail;
  detail << "image/readout_time: " << p.image.readout_time << " s is longer than the " << longest
         << " s from one pair to the next (path/rate)";
  return {Reason::kInputInvalid, detail.str()};
}

}  // namespace

/// The scene of the images and the cameras that take them. The same parameters give the same world.
struct ApproachSimulator::World {
  SimulatorParameters parameters;
  CameraRig rig;
  Trajectory trajectory;
  RollingShutter shutter;
  GroundProfile profile;
  Renderer renderer;
  OwnFrame left_frame, right_frame;
  int frames;

  World(const SimulatorParameters& p, CameraRig cameras)
      : parameters(p),
        rig(std::move(cameras)),
        trajectory(p.path, p.wobble, p.gust, p.random.seed, p.vibration),
        shutter(p.image),
        profile(p.profile),
        renderer(
            Scene(p.runway, p.surface, p.random.seed, Scenery(p.scenery, p.runway, p.surface, p.random.seed)),
            standOn(profile, placeObjects(p.objects, p.runway.width, p.random.seed)), p.image, profile,
            RunwayLights(p.lights, p.runway, p.surface.visibility, profile)),
        left_frame(p.scenery.own_frame, p.image, OwnFrame::Side::kLeft),
        right_frame(p.scenery.own_frame, p.image, OwnFrame::Side::kRight),
        frames(1 + static_cast<int>(std::floor(p.path.duration * p.path.rate + 1e-6))) {}

  double timeOf(int index) const { return index / parameters.path.rate; }

  /// Height of the lower camera above the ground, m.
  double lowerCamera(double time) const {
    const CameraPose pose = trajectory.pose(time);
    const double left = pose.position.z() - profile.height(pose.position.x());
    return left + std::min(0.0, rig.right.offset_x * runwayFromOptical(pose.attitude)(2, 0));
  }

  Failure checkHeights() const {
    constexpr double kLowest = 0.01;
    for (int i = 0; i < frames; ++i) {
      const double before = lowerCamera(timeOf(i) + shutter.first());
      if (std::min(before, lowerCamera(timeOf(i) + shutter.last())) >= kLowest) continue;
      std::ostringstream detail;
      detail << "path/duration: a camera touches the ground after " << timeOf(i) << " s";
      return {Reason::kInputInvalid, detail.str()};
    }
    return {};
  }

  /// Renders the image at once, or line by line, each line at its own time.
  void render(const SimulatedCamera& camera, double time, cv::Mat& grey) const {
    if (shutter.atOnce()) return renderer.render(camera, trajectory.pose(time), grey);
    grey.create(camera.calibration.height, camera.calibration.width, CV_32F);
    cv::parallel_for_(cv::Range(0, shutter.lines()), [&](const cv::Range& lines) {
      for (int line = lines.start; line < lines.end; ++line)
        renderer.render(camera, trajectory.pose(time + shutter.timeOf(line)), shutter.part(line), grey);
    });
  }

  /// When a camera exposes the frame, s. Its stamp is timeOf(index).
  double exposureOf(int index, const SimulatedCameraParameters& camera) const {
    return timeOf(index) + camera.clock_drift * std::max(0.0, timeOf(index) - camera.clock_drift_start);
  }

  cv::Mat lightIn(const SimulatedCamera& camera, const OwnFrame& own, double time) const {
    const SimulatedImageParameters& image = parameters.image;
    const int samples = image.exposure_time > 0 ? image.exposure_samples : 1;
    cv::Mat grey, sum;
    for (int i = 0; i < samples; ++i) {
      const double shift = image.exposure_time * ((i + 0.5) / samples - 0.5);
      render(camera, time + shift, grey);
      if (i == 0)
        grey.copyTo(sum);
      else
        sum += grey;
    }
    if (samples > 1) sum /= samples;
    own.draw(sum);
    return sum;
  }

  cv::Mat picture(const cv::Mat& light, const SimulatedCameraParameters& sensor, int index, int camera_number,
                  double noise) const {
    const uint64_t picture_number = 2 * static_cast<uint64_t>(index) + camera_number;
    const uint64_t seed = (static_cast<uint64_t>(parameters.random.seed) << 32) + picture_number + 1;
    SimulatedImageParameters image = parameters.image;
    image.noise = noise;
    image.blur = renderer.blurLeft();
    cv::Mat grey = light.clone(), mono8;
    uav_landing::expose(image, sensor, seed * 0x9E3779B97F4A7C15ULL, grey, mono8);
    return mono8;
  }
};

Expected<ApproachSimulator> ApproachSimulator::create(const SimulatorParameters& parameters) {
  if (Failure failure = checkReadout(parameters)) return tl::make_unexpected(failure);
  Expected<CameraRig> rig = makeCameraRig(parameters);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto world = std::make_shared<const World>(parameters, std::move(*rig));
  if (Failure failure = world->checkHeights()) return tl::make_unexpected(failure);
  return ApproachSimulator(world);
}

int ApproachSimulator::frames() const { return world_->frames; }
double ApproachSimulator::timeOf(int index) const { return world_->timeOf(index); }
CameraPose ApproachSimulator::pose(double time) const { return world_->trajectory.pose(time); }
const CameraRig& ApproachSimulator::rig() const { return world_->rig; }

SimulatedImu ApproachSimulator::imu() const {
  const SimulatorParameters& parameters = world_->parameters;
  return {parameters.imu, world_->trajectory, static_cast<uint64_t>(parameters.random.seed)};
}

ApproachSimulator::Light ApproachSimulator::light(int index) const {
  const World& world = *world_;
  const SimulatorParameters& p = world.parameters;
  return {index, world.lightIn(world.rig.left, world.left_frame, world.exposureOf(index, p.left_camera)),
          world.lightIn(world.rig.right, world.right_frame, world.exposureOf(index, p.right_camera))};
}

ApproachSimulator::Frame ApproachSimulator::expose(const Light& light, double noise) const {
  const World& world = *world_;
  Frame frame;
  frame.time = timeOf(light.index);
  frame.left = world.picture(light.left, world.parameters.left_camera, light.index, 0, noise);
  frame.right = world.picture(light.right, world.parameters.right_camera, light.index, 1, noise);
  const CameraPose now = pose(frame.time), before = pose(timeOf(light.index - 1));
  frame.truth = truthOf(now, light.index > 0 ? &before : nullptr, 1.0 / world.parameters.path.rate,
                        world.rig.left.calibration.P.leftCols<3>());
  frame.truth.height -= world.profile.height(now.position.x());
  return frame;
}

ApproachSimulator::Frame ApproachSimulator::frame(int index) const {
  return expose(light(index), world_->parameters.image.noise);
}

}  // namespace uav_landing
