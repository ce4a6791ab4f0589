#include "uav_landing/simulator/approach_simulator.h"

#include <cmath>
#include <sstream>

#include "uav_landing/simulator/sensor.h"

namespace uav_landing {

namespace {

/// Objects moved from z = 0 to the ground's height where they stand.
std::vector<StandingObject> standOn(const GroundProfile& ground, std::vector<StandingObject> objects) {
  for (StandingObject& object : objects) {
    const auto lift = static_cast<float>(ground.height(0.5 * (object.low.x() + object.high.x())));
    object.low.z() += lift;
    object.high.z() += lift;
  }
  return objects;
}

}  // namespace

Expected<ApproachSimulator> ApproachSimulator::create(const SimulatorParameters& parameters) {
  Expected<CameraRig> rig = makeCameraRig(parameters);
  if (!rig) return tl::make_unexpected(rig.error());
  ApproachSimulator simulator(parameters, std::move(*rig));
  if (Failure failure = simulator.checkHeights()) return tl::make_unexpected(failure);
  return simulator;
}

ApproachSimulator::ApproachSimulator(const SimulatorParameters& parameters, CameraRig rig)
    : parameters_(parameters),
      rig_(std::move(rig)),
      trajectory_(parameters.path, parameters.wobble, parameters.gust, parameters.random.seed),
      profile_(parameters.profile),
      renderer_(Scene(parameters.runway, parameters.surface, parameters.random.seed),
                standOn(profile_,
                        placeObjects(parameters.objects, parameters.runway.width, parameters.random.seed)),
                parameters.image, profile_),
      frames_(1 + static_cast<int>(std::floor(parameters.path.duration * parameters.path.rate + 1e-6))) {}

Failure ApproachSimulator::checkHeights() const {
  constexpr double kLowest = 0.01;
  for (int i = 0; i < frames_; ++i) {
    const CameraPose pose = trajectory_.pose(timeOf(i));
    const double left = pose.position.z() - profile_.height(pose.position.x());
    const double right = left + rig_.right.offset_x * runwayFromOptical(pose.attitude)(2, 0);
    if (std::min(left, right) >= kLowest) continue;
    std::ostringstream detail;
    detail << "path/duration: a camera touches the ground after " << timeOf(i) << " s";
    return {Reason::kInputInvalid, detail.str()};
  }
  return {};
}

cv::Mat ApproachSimulator::lightIn(const SimulatedCamera& camera, int index) const {
  const SimulatedImageParameters& image = parameters_.image;
  const int samples = image.exposure_time > 0 ? image.exposure_samples : 1;
  cv::Mat grey, sum;
  for (int i = 0; i < samples; ++i) {
    const double shift = image.exposure_time * ((i + 0.5) / samples - 0.5);
    renderer_.render(camera, trajectory_.pose(timeOf(index) + shift), grey);
    if (i == 0)
      grey.copyTo(sum);
    else
      sum += grey;
  }
  if (samples > 1) sum /= samples;
  return sum;
}

cv::Mat ApproachSimulator::picture(const cv::Mat& light, const SimulatedCameraParameters& sensor, int index,
                                   int camera_number, double noise) const {
  const uint64_t picture_number = 2 * static_cast<uint64_t>(index) + camera_number;
  const uint64_t seed = (static_cast<uint64_t>(parameters_.random.seed) << 32) + picture_number + 1;
  SimulatedImageParameters image = parameters_.image;
  image.noise = noise;
  image.blur = renderer_.blurLeft();
  cv::Mat grey = light.clone(), mono8;
  uav_landing::expose(image, sensor, seed * 0x9E3779B97F4A7C15ULL, grey, mono8);
  return mono8;
}

ApproachSimulator::Light ApproachSimulator::light(int index) const {
  return {index, lightIn(rig_.left, index), lightIn(rig_.right, index)};
}

ApproachSimulator::Frame ApproachSimulator::expose(const Light& light, double noise) const {
  Frame frame;
  frame.time = timeOf(light.index);
  frame.left = picture(light.left, parameters_.left_camera, light.index, 0, noise);
  frame.right = picture(light.right, parameters_.right_camera, light.index, 1, noise);
  const CameraPose now = trajectory_.pose(timeOf(light.index));
  const CameraPose before = trajectory_.pose(timeOf(light.index - 1));
  frame.truth = truthOf(now, light.index > 0 ? &before : nullptr, 1.0 / parameters_.path.rate,
                        rig_.left.calibration.P.leftCols<3>());
  frame.truth.height -= profile_.height(now.position.x());
  return frame;
}

ApproachSimulator::Frame ApproachSimulator::frame(int index) const {
  return expose(light(index), parameters_.image.noise);
}

}  // namespace uav_landing
