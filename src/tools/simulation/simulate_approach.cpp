// Renders an approach with ground truth into a bag and, on request, into a dataset folder; or publishes it.

#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "bags/stereo_bag_writer.h"
#include "camera_info.h"
#include "command_line.h"
#include "datasets/dataset_writer.h"
#include "progress_bar.h"
#include "simulation/live_cameras.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace {

using namespace uav_landing;

struct Options {
  std::string config, output, dataset, camera = "stereo";
  bool live = false, loop = false;
  double speed = 1;
  std::optional<int> seed;
  std::optional<double> duration;
};

/// Stamp of a frame. The first one is 100 s, because a stamp of 0 means that there is none.
ros::Time stampOf(double time) {
  ros::Time stamp;
  return stamp.fromNSec(100000000000ULL + static_cast<uint64_t>(std::llround(time * 1e9)));
}

/// Publishes all frames as running cameras do, once or until ROS is shut down. A new round begins a minute
/// later by the clock, so that it is another approach.
void fly(const ApproachSimulator& simulator, LiveCameras& cameras, bool loop) {
  if (!cameras.waitForSubscribers(stampOf(0))) return;
  double start = 0;
  do {
    double time = start;
    for (int i = 0; i < simulator.frames(); ++i) {
      const ApproachSimulator::Frame frame = simulator.frame(i);
      time = start + frame.time;
      if (!cameras.publish(stampOf(time), frame.left, frame.right, frame.truth)) return;
    }
    start = time + 60;
    cameras.setClock(stampOf(start));
  } while (loop);
}

/// Renders all frames into the bag and the dataset (null: none).
Failure simulate(const ApproachSimulator& simulator, StereoBagWriter& bag, DatasetWriter* dataset) {
  ProgressBar progress(simulator.frames());
  const SimulatedImu imu = simulator.imu();
  const int imu_messages = imu.count(simulator.duration());
  const Eigen::Matrix3d left_from_imu = simulator.rig().left.calibration.R.transpose() * opticalFromImu();
  int imu_next = 0;
  for (int i = 0; i < simulator.frames(); ++i, progress.step()) {
    const ApproachSimulator::Frame frame = simulator.frame(i);
    const ros::Time stamp = stampOf(frame.time);
    for (; imu_next < imu_messages && imu.sample(imu_next).stamp <= frame.time; ++imu_next) {
      const ImuSample sample = imu.sample(imu_next);
      bag.writeImu(stampOf(sample.stamp), sample, left_from_imu);
    }
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
  if (options.live) {
    LiveCameras cameras(options.camera, left, right, options.speed);
    fly(*simulator, cameras, options.loop);
    return {};
  }
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
  auto* output = app.add_option_group("output", "one of them")->require_option(1);
  output->add_option("--output", options.output, "bag to write");
  auto* live = output->add_flag("--live", options.live,
                                "publish as running cameras do, with a clock, once they have subscribers");
  app.add_option("--dataset", options.dataset, "write this dataset folder, too")->excludes(live);
  app.add_flag("--loop", options.loop, "with --live: fly the approach again and again")->needs(live);
  app.add_option("--speed", options.speed, "with --live: seconds of the clock in a second, at most")
      ->needs(live)
      ->capture_default_str()
      ->check(CLI::Range(0.01, 100.0));
  app.add_option("--camera", options.camera, "namespace of the camera topics")
      ->capture_default_str()
      ->check(isCameraName());
  app.add_option("--seed", options.seed, "instead of the config's random/seed")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--duration", options.duration, "instead of the config's path/duration, s")
      ->check(CLI::Range(0.0, 3600.0));
  // roslaunch appends its own arguments, such as __name:=cameras.
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  std::vector<char*> own;
  for (std::string& argument : arguments) own.push_back(argument.data());
  if (const auto status = parseCommandLine(app, static_cast<int>(own.size()), own.data())) return *status;
  return exitStatusOf(app, options.live ? "" : options.output, [&] {
    if (options.live) ros::init(argc, argv, "simulate_approach");
    return run(options);
  });
}
