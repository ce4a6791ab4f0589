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

void scale(SimulatedCameraParameters& camera, double factor) {
  camera.fx *= factor;
  camera.fy *= factor;
  camera.cx = (camera.cx + 0.5) * factor - 0.5;
  camera.cy = (camera.cy + 0.5) * factor - 0.5;
  camera.k1 = kDistortion;
}

}  // namespace

Expected<Sequence> simulatedSequence(const std::string& config, int width, int pairs) {
  Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(config);
  if (!parameters) return tl::make_unexpected(parameters.error());
  const double factor = static_cast<double>(width) / parameters->image.width;
  parameters->image.width = width;
  parameters->image.height = static_cast<int>(std::lround(parameters->image.height * factor));
  scale(parameters->left_camera, factor);
  scale(parameters->right_camera, factor);
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(*parameters);
  if (!simulator) return tl::make_unexpected(simulator.error());
  Sequence sequence{"simulated " + std::to_string(width) + "x" + std::to_string(parameters->image.height),
                    simulator->rig().left.calibration,
                    simulator->rig().right.calibration,
                    {}};
  // From the middle of the approach on, where the runway fills much of the picture.
  const int first = simulator->frames() / 2;
  for (int i = first; i < std::min(first + pairs, simulator->frames()); ++i) {
    const ApproachSimulator::Frame frame = simulator->frame(i);
    sequence.pairs.push_back({100 + frame.time, frame.left, frame.right});
  }
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
