// The whole chain offline: reads the image pairs of a bag, and writes estimates, messages, timing and images.

#include <algorithm>
#include <exception>
#include <filesystem>
#include <regex>

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
  std::vector<std::string> inputs;
  std::string camera = "stereo", imu = "/imu/data", config, csv, output, report_data;
  bool imu_needed = false;
};

/// Problems on the way, written to stderr. A stream of ever new problems is cut short.
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
                                                 std::size_t pairs) {
  std::vector<std::unique_ptr<PairSink>> sinks;
  if (!options.csv.empty()) sinks.push_back(std::make_unique<EstimateCsv>(options.csv));
  if (!options.output.empty()) sinks.push_back(std::make_unique<EstimateBag>(options.output));
  if (!options.report_data.empty())
    sinks.push_back(std::make_unique<ReportData>(options.report_data, pairs, parameters.overlay));
  sinks.push_back(std::make_unique<TimingTable>(std::cout));
  sinks.push_back(std::make_unique<PairCount>(std::cout));
  return sinks;
}

/// The next part of a split recording, if it lies beside this one and was not given.
std::string nextPart(const std::vector<std::string>& inputs) {
  static const std::regex part("(.*_)([0-9]{1,6})\\.bag");
  std::smatch match;
  if (!std::regex_match(inputs.back(), match, part)) return "";
  const std::string next = match[1].str() + std::to_string(std::stoi(match[2].str()) + 1) + ".bag";
  if (!std::filesystem::exists(next) || std::find(inputs.begin(), inputs.end(), next) != inputs.end())
    return "";
  return next;
}

std::string listed(const std::vector<std::string>& inputs) {
  return inputs.size() == 1 ? inputs.front()
                            : inputs.front() + " and " + std::to_string(inputs.size() - 1) + " more";
}

Failure processBag(const Options& options, const Parameters& parameters, Complaints& complain,
                   bool& left_out) {
  StereoBagReader reader(options.inputs, options.camera, options.imu);
  const std::string input = listed(options.inputs);
  if (const Failure failure = reader.checkTopics(options.imu_needed))
    return {failure.reason, input + ": " + failure.detail};
  if (const std::string next = nextPart(options.inputs); !next.empty())
    complain(next +
             " lies beside the input: if it is the next part of the same recording, give it to --input, too");

  ProgressBar reading(reader.messages());
  const PairPlan plan = reader.plan(parameters.rectify, [&] { reading.step(); });
  if (plan.pairs.empty()) return {Reason::kInputInvalid, input + ": no image pair: " + plan.complaint()};
  std::vector<std::unique_ptr<PairSink>> sinks = makeSinks(options, parameters, plan.pairs.size());
  OfflineChain chain(parameters, options.camera, reader.hasImu(), sinks, std::ref(complain));
  ProgressBar progress(plan.pairs.size());
  reader.readStaticTransforms([&](const auto& message) { chain.addTransforms(message); });
  reader.read(
      plan,
      [&](const auto&... messages) {
        chain.process(messages...);
        progress.step();
      },
      [&](const auto& message) { chain.addImu(message, options.imu); });
  chain.finish();

  if (chain.unusable() == chain.pairs())
    return {Reason::kInputInvalid, input + ": no usable image pair: " + chain.firstProblem().detail};
  for (const std::string& note : plan.notes()) complain(note);
  if (chain.repetitions() > 0)
    complain(std::to_string(chain.repetitions()) + " of " + std::to_string(plan.pairs.size()) +
             " pairs repeat the images of the one before, and were left out");
  if (chain.unusable() > 0)
    complain(std::to_string(chain.unusable()) + " of " + std::to_string(chain.pairs()) +
             " pairs could not be used");
  for (const auto& sink : sinks) sink->finish();
  left_out = plan.mostLeftOut();
  if (left_out)
    complain("most of the recording was left out: " + std::to_string(plan.pairs.size()) + " pairs of " +
             std::to_string(plan.inputs[0].received) + " left and " +
             std::to_string(plan.inputs[2].received) + " right images (exit status 3)");
  return {};
}

int run(const CLI::App& app, const Options& options) {
  const Expected<Parameters> parameters = parametersOf(options.config);
  if (!parameters) return inputUnusable(app, parameters.error().detail);
  for (const std::string& written : {options.output, options.csv}) {
    std::error_code none;
    for (const std::string& input : options.inputs)
      if (!written.empty() && std::filesystem::equivalent(input, written, none))
        return inputUnusable(app, written + ": is the input");
  }
  if (!options.csv.empty() &&
      std::filesystem::weakly_canonical(options.csv) == std::filesystem::weakly_canonical(options.output))
    return inputUnusable(app, options.csv + ": is the bag to write");
  Complaints complain(app);
  bool left_out = false;
  const Failure failure = processBag(options, *parameters, complain, left_out);
  if (failure) return inputUnusable(app, failure.detail);
  return left_out ? kMostLeftOut : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs the whole chain on the image pairs of a bag, as fast as it goes.", "process_bag");
  Options options;
  app.add_option("--input", options.inputs,
                 "bag with /<camera>/{left,right}/{image_raw,camera_info}, or all parts of a split one")
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
                 "folder for what `evaluate --report` needs: timing.csv and drawings");
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
    return inputUnusable(app, listed(options.inputs) + ": " + error.what());
  } catch (const std::exception& error) {
    return inputUnusable(app, error.what());
  }
}
