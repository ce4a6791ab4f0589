// The whole chain offline: reads the image pairs of a bag, writes estimates, messages, timing and pictures.

#include <exception>
#include <filesystem>

#include "bags/stereo_bag_reader.h"
#include "command_line.h"
#include "node_parameter_table.h"
#include "offline/estimate_bag.h"
#include "offline/estimate_csv.h"
#include "offline/offline_chain.h"
#include "offline/pair_count.h"
#include "offline/report_data.h"
#include "offline/timing_table.h"
#include "progress_bar.h"

namespace {

using namespace uav_landing;

struct Options {
  std::string input, camera = "stereo", imu = "/imu/data", config, csv, output, report_data;
  bool imu_needed = false;
};

/// What goes wrong on the way, to stderr; a stream of ever new problems is cut short.
class Complaints {
 public:
  explicit Complaints(const CLI::App& app) : program_(app.get_name()) {}
  void operator()(const std::string& text) {
    constexpr int kMost = 20;
    if (++count_ > kMost) return;
    std::cerr << program_ << ": " << text << '\n';
    if (count_ == kMost) std::cerr << program_ << ": more of this is not shown\n";
  }

 private:
  std::string program_;
  int count_ = 0;
};

std::vector<std::unique_ptr<PairSink>> makeSinks(const Options& options, const Parameters& parameters,
                                                 const StereoBagReader& reader) {
  std::vector<std::unique_ptr<PairSink>> sinks;
  if (!options.csv.empty()) sinks.push_back(std::make_unique<EstimateCsv>(options.csv));
  if (!options.output.empty()) sinks.push_back(std::make_unique<EstimateBag>(options.output));
  if (!options.report_data.empty())
    sinks.push_back(
        std::make_unique<ReportData>(options.report_data, reader.leftImages(), parameters.overlay));
  sinks.push_back(std::make_unique<TimingTable>(std::cout));
  sinks.push_back(std::make_unique<PairCount>(std::cout));
  return sinks;
}

/// Images that found no partner, and clocks that were set back.
void reportPairing(const StereoPairing& pairing, Complaints& complain) {
  for (const InputWatch::Input& input : pairing.inputs()) {
    const auto unpaired = input.received - input.paired;
    if (unpaired == 0) continue;
    std::string why;
    if (input.unstamped > 0) why += ", of them " + std::to_string(input.unstamped) + " with the stamp 0";
    if (input.repeated > 0) why += ", of them " + std::to_string(input.repeated) + " with a repeated stamp";
    if (input.late > 0) why += ", of them " + std::to_string(input.late) + " came after newer ones";
    complain(std::to_string(unpaired) + " of " + std::to_string(input.received) + " messages on " +
             input.topic + " belong to no pair" + why);
  }
  if (pairing.jumps() > 0) complain("stamps went back " + std::to_string(pairing.jumps()) + " times");
}

Failure processBag(const Options& options, const Parameters& parameters, Complaints& complain) {
  const StereoBagReader reader(options.input, options.camera, options.imu);
  if (const Failure failure = reader.checkTopics(options.imu_needed))
    return {failure.reason, options.input + ": " + failure.detail};

  std::vector<std::unique_ptr<PairSink>> sinks = makeSinks(options, parameters, reader);
  OfflineChain chain(parameters, options.camera, reader.hasImu(), sinks, std::ref(complain));
  StereoPairing pairing(parameters.rectify, {reader.topics().begin(), reader.topics().end()},
                        [&](const auto&... messages) { chain.process(messages...); });
  ProgressBar progress(reader.messages());
  reader.readStaticTransforms([&](const auto& message) { chain.addTransforms(message); });
  reader.read(
      pairing, [&](const auto& message) { chain.addImu(message, options.imu); }, [&] { progress.step(); });
  chain.finish();

  if (chain.pairs() == 0)
    return {Reason::kInputInvalid, options.input + ": no image pair: " + pairing.complaint()};
  if (chain.unusable() == chain.pairs())
    return {Reason::kInputInvalid, options.input + ": no usable image pair: " + chain.firstProblem().detail};
  reportPairing(pairing, complain);
  if (chain.unusable() > 0)
    complain(std::to_string(chain.unusable()) + " of " + std::to_string(chain.pairs()) +
             " pairs could not be used");
  for (const auto& sink : sinks) sink->finish();
  return {};
}

int run(const CLI::App& app, const Options& options) {
  const Expected<Parameters> parameters = parametersOf(options.config);
  if (!parameters) return inputUnusable(app, parameters.error().detail);
  for (const std::string& written : {options.output, options.csv}) {
    std::error_code none;
    if (!written.empty() && std::filesystem::equivalent(options.input, written, none))
      return inputUnusable(app, written + ": is the input");
  }
  if (!options.csv.empty() &&
      std::filesystem::weakly_canonical(options.csv) == std::filesystem::weakly_canonical(options.output))
    return inputUnusable(app, options.csv + ": is the bag to write");
  Complaints complain(app);
  const Failure failure = processBag(options, *parameters, complain);
  return failure ? inputUnusable(app, failure.detail) : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs the whole chain on the image pairs of a bag, as fast as it goes.", "process_bag");
  Options options;
  app.add_option("--input", options.input, "bag with /<camera>/{left,right}/{image_raw,camera_info}")
      ->required();
  app.add_option("--camera", options.camera, "namespace of the camera topics")
      ->capture_default_str()
      ->check(isCameraName());
  CLI::Option* imu =
      app.add_option("--imu", options.imu,
                     "topic of an inertial sensor (sensor_msgs/Imu); the default may be missing, "
                     "an empty one means none")
          ->capture_default_str();
  app.add_option("--config", options.config, "parameter file; without it the defaults");
  app.add_option("--csv", options.csv, "estimates to write, one row per pair");
  app.add_option("--output", options.output,
                 "bag to write, with stereo_depth, approach_angle and landing_estimate");
  app.add_option("--report-data", options.report_data,
                 "folder for what `evaluate --report` needs: timing.csv and pictures");
  app.add_flag_callback(
      "--list-parameters",
      [] {
        std::cout << parameterTable();
        throw CLI::Success();
      },
      "print what a config file may hold, with defaults and meaning (docs/parameters.md), and leave");
  app.add_flag_callback(
      "--list-node-parameters",
      [] {
        std::cout << nodeParameterTable();
        throw CLI::Success();
      },
      "print the nodelets' parameters that are in no config file (docs/node_parameters.md), and leave");
  app.add_flag_callback(
      "--list-tests",
      [] {
        std::cout << integrityTestPage();
        throw CLI::Success();
      },
      "print the tests of integrity, with limits and what follows (docs/integrity_tests.md), and leave");
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  options.imu_needed = imu->count() > 0 && !options.imu.empty();
  try {
    return run(app, options);
  } catch (const ros::Exception& error) {
    return inputUnusable(app, options.input + ": " + error.what());
  } catch (const std::exception& error) {
    return inputUnusable(app, error.what());
  }
}
