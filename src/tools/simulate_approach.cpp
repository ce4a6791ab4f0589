// Renders an approach with ground truth into a bag and, if wanted, into a dataset folder.

#include <cmath>
#include <exception>
#include <iostream>
#include <optional>

#include "camera_info.h"
#include "command_line.h"
#include "dataset_writer.h"
#include "progress_bar.h"
#include "stereo_bag_writer.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace {

using namespace uav_landing;

struct Options {
  std::string config, output, dataset, camera = "stereo";
  std::optional<int> seed;
  std::optional<double> duration;
};

/// Stamp of a frame; the first is 100 s, because a stamp of 0 means that there is none.
ros::Time stampOf(double time) {
  ros::Time stamp;
  return stamp.fromNSec(100000000000ULL + static_cast<uint64_t>(std::llround(time * 1e9)));
}

/// Renders all frames into the bag and the dataset (null: none).
Failure simulate(const ApproachSimulator& simulator, StereoBagWriter& bag, DatasetWriter* dataset) {
  ProgressBar progress(simulator.frames());
  for (int i = 0; i < simulator.frames(); ++i, progress.step()) {
    const ApproachSimulator::Frame frame = simulator.frame(i);
    const ros::Time stamp = stampOf(frame.time);
    bag.write(stamp, frame.left, frame.right, frame.truth);
    if (dataset == nullptr) continue;
    if (const Failure failure = dataset->write(stamp, frame.left, frame.right, frame.truth)) return failure;
  }
  return {};
}

Failure run(const Options& options) {
  Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(options.config);
  if (!parameters) return parameters.error();
  if (options.seed) parameters->random.seed = *options.seed;
  if (options.duration) parameters->path.duration = *options.duration;
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(*parameters);
  if (!simulator) return {Reason::kInputInvalid, options.config + ": " + simulator.error().detail};

  const sensor_msgs::CameraInfo left = toCameraInfo(simulator->rig().left.calibration, {});
  const sensor_msgs::CameraInfo right = toCameraInfo(simulator->rig().right.calibration, {});
  std::optional<DatasetWriter> dataset;
  if (!options.dataset.empty()) {
    dataset.emplace(options.dataset);
    if (const Failure failure = dataset->open(left, right)) return failure;
  }
  StereoBagWriter bag(options.output, options.camera, left, right);
  if (const Failure failure = simulate(*simulator, bag, dataset ? &*dataset : nullptr)) return failure;
  bag.finish();
  if (dataset) return dataset->finish();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders the approach of a stereo rig to a runway, with ground truth.", "simulate_approach");
  Options options;
  app.add_option("--config", options.config, "what to simulate, see config/simulator/")->required();
  app.add_option("--output", options.output, "bag to write")->required();
  app.add_option("--dataset", options.dataset, "write this dataset folder, too");
  app.add_option("--camera", options.camera, "namespace of the camera topics")
      ->capture_default_str()
      ->check(isCameraName());
  app.add_option("--seed", options.seed, "instead of the config's random/seed")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--duration", options.duration, "instead of the config's path/duration, s")
      ->check(CLI::Range(0.0, 3600.0));
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  try {
    if (const Failure failure = run(options)) return inputUnusable(app, failure.detail);
  } catch (const std::exception& error) {
    return inputUnusable(app, options.output + ": " + error.what());
  }
  return kDone;
}
