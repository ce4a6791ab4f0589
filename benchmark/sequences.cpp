#include "sequences.h"

#include <algorithm>
#include <cmath>

#include "camera_info.h"
#include "datasets/dataset.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace benchmark {
namespace {

constexpr double kDistortion = -0.1;  // k1 of both lenses

void scale(SimulatedCameraParameters& camera, double factor, double rows_added) {
  camera.fx *= factor;
  camera.fy *= factor;
  camera.cx = (camera.cx + 0.5) * factor - 0.5;
  camera.cy = (camera.cy + 0.5) * factor - 0.5 + rows_added;
  camera.k1 = kDistortion;
}

void resize(SimulatorParameters& parameters, const cv::Size& size) {
  const double factor = static_cast<double>(size.width) / parameters.image.width;
  const double rows_added = 0.5 * (size.height - factor * parameters.image.height);
  parameters.image.width = size.width;
  parameters.image.height = size.height;
  scale(parameters.left_camera, factor, rows_added);
  scale(parameters.right_camera, factor, rows_added);
}

// Adds at most so many pairs, from `first` on.
void add(const ApproachSimulator& simulator, int first, int pairs, Sequence& sequence) {
  for (int i = first; i < std::min(first + pairs, simulator.frames()); ++i) {
    const ApproachSimulator::Frame frame = simulator.frame(i);
    sequence.pairs.push_back({100 + frame.time, frame.left, frame.right});
  }
}

Sequence withoutPairs(const std::string& name, const ApproachSimulator& simulator) {
  return {name, simulator.rig().left.calibration, simulator.rig().right.calibration, {}};
}

}  // namespace

Expected<Sequence> simulatedSequence(const std::string& config, const cv::Size& size, int pairs) {
  Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(config);
  if (!parameters) return tl::make_unexpected(parameters.error());
  resize(*parameters, size);
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(*parameters);
  if (!simulator) return tl::make_unexpected(simulator.error());
  Sequence sequence =
      withoutPairs("simulated " + std::to_string(size.width) + "x" + std::to_string(size.height), *simulator);
  // From the middle of the approach on, where the runway fills much of the image.
  add(*simulator, simulator->frames() / 2, pairs, sequence);
  return sequence;
}

Expected<Sequence> simulatedSequence(const std::string& config, int width, int pairs) {
  const Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(config);
  if (!parameters) return tl::make_unexpected(parameters.error());
  const double factor = static_cast<double>(width) / parameters->image.width;
  const cv::Size size(width, static_cast<int>(std::lround(parameters->image.height * factor)));
  return simulatedSequence(config, size, pairs);
}

Expected<Sequence> wholeApproach(const std::string& config) {
  const Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(config);
  if (!parameters) return tl::make_unexpected(parameters.error());
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(*parameters);
  if (!simulator) return tl::make_unexpected(simulator.error());
  const std::string file = config.substr(config.find_last_of('/') + 1);
  Sequence sequence = withoutPairs(file.substr(0, file.find('.')), *simulator);
  add(*simulator, 0, simulator->frames(), sequence);
  return sequence;
}

Expected<Sequence> recordedSequence(const std::string& folder, int pairs) {
  const Expected<Dataset> dataset = readDataset(folder);
  if (!dataset) return tl::make_unexpected(dataset.error());
  Sequence sequence{folder.substr(folder.find_last_of('/') + 1),
                    toCalibration(dataset->left),
                    toCalibration(dataset->right),
                    {}};
  for (const DatasetFrame& frame : dataset->frames) {
    if (static_cast<int>(sequence.pairs.size()) >= pairs) break;
    const Expected<cv::Mat> left = readImage(frame.left, sequence.left.imageSize());
    if (!left) return tl::make_unexpected(left.error());
    const Expected<cv::Mat> right = readImage(frame.right, sequence.right.imageSize());
    if (!right) return tl::make_unexpected(right.error());
    sequence.pairs.push_back({frame.stamp.toSec(), *left, *right});
  }
  return sequence;
}

}  // namespace benchmark
}  // namespace uav_landing
