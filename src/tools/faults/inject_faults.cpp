// Flies simulated approaches or a dataset through the chain, with one or two faults from a random moment on.
// It counts what was available, what was misleading, and how long it took to notice.

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "command_line.h"
#include "csv_row.h"
#include "faults/fault_flight.h"
#include "pending_file.h"
#include "progress_bar.h"
#include "simulator/ground/ground_profile.h"
#include "uav_landing/geometry/rig_check.h"

namespace {

using namespace uav_landing;

struct Options {
  std::string config, csv, dataset, scenery, trace;
  bool threshold = false;
  std::vector<std::string> faults;
  uint64_t first = 1;
  int count = 10, frames = 70, pairs = 0;
};

constexpr const char* kHeader =
    "source,seed,faults,onset_s,healthy,healthy_valid,healthy_misleading,faulted,faulted_valid,beyond_level,"
    "beyond_limit,misleading,time_to_alert_s,worst_level_ratio,worst_limit_ratio,alarm,healthy_uncertain,"
    "healthy_tests";
/// Columns of each output besides the height; its name comes before them.
constexpr const char* kOutputColumns[] = {"healthy_known", "healthy_misleading", "known",
                                          "misleading",    "worst_ratio",        "time_to_alert_s"};
constexpr const char* kTraceHeader =
    "source,seed,faults,time_s,faulted,true_height_m,height_m,valid,protection_level_m,protection_source,"
    "alert_limit_m,raw_height_m,status,reason,failed_tests,true_angle_deg,angle_deg,angle_stddev_deg,angle_"
    "valid,true_speed_m_s,speed_m_s,speed_stddev_m_s,true_yaw_deg,yaw_deg,yaw_stddev_deg,yaw_reason,"
    "other_runway_probability,true_x_m,x_m,x_stddev_m,true_y_m,y_m,y_stddev_m,y_protection_level_m,"
    "true_height_above_runway_m,height_above_runway_m,height_above_runway_protection_level_m,height_above_"
    "runway_known";

std::string withoutCommas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

class Campaign {
 public:
  Campaign(const Options& options, const Parameters& parameters)
      : options_(options),
        parameters_(parameters),
        choice_(options.faults, options.pairs, options.dataset.empty()),
        pending_(options.csv),
        file_(pending_.temporary()) {
    if (!file_) throw std::runtime_error(options.csv + ": cannot be written");
    file_ << kHeader;
    for (const char* output : kOutputNames)
      for (const char* column : kOutputColumns) file_ << ',' << output << '_' << column;
    file_ << '\n';
    if (!options.trace.empty()) {
      trace_.open(options.trace);
      if (!trace_) throw std::runtime_error(options.trace + ": cannot be written");
      trace_ << kTraceHeader;
      for (const char* output : kOutputNames) trace_ << ',' << output << "_ratio";
      trace_ << '\n';
    }
  }

  void run() {
    const Flight recorded = options_.dataset.empty() ? Flight() : readFlight(options_.dataset);
    for (const std::string& warning : rigWarnings(recorded.left, recorded.right, parameters_.rig))
      std::cerr << "inject_faults: " << warning << '\n';
    ProgressBar progress(static_cast<unsigned long>(options_.count));
    for (uint64_t seed = options_.first; seed < options_.first + options_.count; ++seed) {
      if (options_.dataset.empty())
        flySimulated(seed);
      else
        flyRecorded(recorded, seed);
      progress.step();
    }
    file_.close();
    if (!file_) throw std::runtime_error(options_.csv + ": could not be written completely");
    pending_.commit();
  }

 private:
  /// Start of the faults. It is late enough for the chain to have settled, and early enough to see what
  /// happens after a restart.
  struct Chance {
    Chance(const FaultCombination& faults, uint64_t seed, int frames) : hash(seed) {
      for (const char letter : nameOf(faults)) hash = hash * 31 + static_cast<unsigned char>(letter);
      cv::RNG random(hash);
      in_flight = random.uniform(frames * 5 / 20, frames * 7 / 20);
    }
    uint64_t hash;
    int in_flight;  ///< first frame with the faults that begin in flight
  };

  /// Returns a name for the changed scene; empty when nothing changes it.
  std::string changeScene(const FaultCombination& faults, uint64_t seed, SimulatorParameters& scene) const {
    const int in_flight = Chance(faults, seed, options_.frames).in_flight;
    std::string name;
    for (const Fault* fault : faults) {
      if (fault->build) fault->build(scene);
      if (fault->disturb) fault->disturb(scene, in_flight / scene.path.rate);
      if (fault->build || fault->disturb) name += fault->name + " ";
      if (fault->disturb) name += std::to_string(in_flight) + " ";
    }
    return name;
  }

  SimulatorParameters draw(uint64_t seed) const {
    if (options_.threshold) return drawThresholdFlight(seed, options_.frames, parameters_);
    if (options_.scenery.empty()) return drawFlight(seed, options_.frames, parameters_);
    return drawFlight(seed, options_.frames, parameters_, &sceneryKinds().at(options_.scenery));
  }

  /// Name of the simulated flights.
  std::string source() const {
    if (options_.threshold) return "threshold";
    return options_.scenery.empty() ? "simulator" : options_.scenery;
  }

  void flySimulated(uint64_t seed) {
    const SimulatorParameters drawn = draw(seed);
    std::map<std::string, std::unique_ptr<SimulatedFlight>> flights;  // by the faults that change the scene
    const bool flat = GroundProfile(drawn.profile).flat();
    for (const FaultCombination& faults : choice_.combinations(seed)) {
      if (!flat && std::any_of(faults.begin(), faults.end(), paintsGround)) continue;
      SimulatorParameters changed = drawn;
      const std::string name = changeScene(faults, seed, changed);
      if (flights.count(name) == 0) flights[name] = simulateFlight(changed);
      if (const auto& flown = flights[name]) flyOne(flown->flight, source(), faults, seed);
    }
  }

  void flyRecorded(const Flight& recorded, uint64_t seed) {
    const int frames = std::min(options_.frames, static_cast<int>(recorded.frames.size()));
    cv::RNG random(seed * 1234567 + 3);
    const int first = random.uniform(0, static_cast<int>(recorded.frames.size()) - frames + 1);
    const Flight part = cutFlight(recorded, first, frames);
    const FaultCombination healthy = {&allFaults().front()};
    std::string name = options_.dataset;
    while (!name.empty() && name.back() == '/') name.pop_back();
    name = name.substr(name.find_last_of('/') + 1);
    // Without a fault the whole recording is flown, because pieces would have frames in common.
    for (const FaultCombination& faults : choice_.combinations(seed))
      flyOne(faults == healthy ? recorded : part, name, faults, seed);
  }

  void flyOne(const Flight& flight, const std::string& source, const FaultCombination& faults,
              uint64_t seed) {
    const int frames = static_cast<int>(flight.frames.size());
    const Chance chance(faults, seed, frames);
    const bool whole =
        std::any_of(faults.begin(), faults.end(), [](const Fault* f) { return f->wholeRun(); });
    const bool healthy = faults.size() == 1 && faults[0]->name == "none";
    const int onset = healthy ? frames : whole ? 0 : chance.in_flight;
    const std::string from = source + "," + std::to_string(seed) + "," + nameOf(faults);
    const FaultObserver observe = [&](double time, const LandingResult& said, const FaultTruth& truth,
                                      bool faulted) { trace(from, time, said, truth, faulted); };
    const FaultScore score = flyWithFaults(flight, faults, chance.in_flight, onset, chance.hash, parameters_,
                                           trace_.is_open() ? observe : FaultObserver());
    CsvRow row(file_);
    row.text(source).text(std::to_string(seed)).text(nameOf(faults));
    row.number(onset < frames ? flight.frames[static_cast<size_t>(onset)].time - flight.frames[0].time
                              : kUnknown);
    row.number(score.healthy).number(score.healthy_valid).number(score.healthy_misleading);
    row.number(score.faulted)
        .number(score.faulted_valid)
        .number(score.beyond_level)
        .number(score.beyond_limit);
    row.number(score.misleading).number(score.time_to_alert).number(score.worst_level_ratio);
    row.number(score.worst_limit_ratio).text(withoutCommas(score.alarm));
    row.number(score.healthy_uncertain).text(score.testCounts());
    for (const OutputScore& output : score.outputs) {
      row.number(output.healthy_known).number(output.healthy_misleading);
      row.number(output.faulted_known).number(output.misleading);
      row.number(output.worst_ratio).number(output.time_to_alert);
    }
    file_ << std::endl;  // flushed, so that finished rows can be looked at
  }

  void trace(const std::string& from, double time, const LandingResult& said, const FaultTruth& truth,
             bool faulted) {
    constexpr double kDegree = M_PI / 180;
    CsvRow row(trace_);
    row.text(from)
        .number(time)
        .flag(faulted)
        .number(truth.height)
        .number(said.height)
        .flag(said.height_valid);
    row.number(said.height_protection_level).text(said.protection_source).number(said.height_alert_limit);
    row.number(said.raw_height).text(toString(said.status)).text(toString(said.failure.reason));
    row.text(failedTests(said.tests));
    row.number(truth.angle / kDegree).number(said.approach_angle / kDegree);
    row.number(std::sqrt(said.approach_angle_variance) / kDegree).flag(said.angle_valid);
    row.number(truth.speed).number(said.speed()).number(std::sqrt(said.speedVariance()));
    row.number(truth.yaw / kDegree).number(said.yaw / kDegree);
    row.number(std::sqrt(said.yaw_variance) / kDegree).text(toString(said.yaw_failure.reason));
    row.number(said.other_runway_probability);
    row.number(truth.x).number(said.x).number(std::sqrt(said.x_variance));
    row.number(truth.y).number(said.y).number(std::sqrt(said.y_variance)).number(said.y_protection_level);
    row.number(truth.height_above_runway).number(said.height_above_runway);
    row.number(said.height_above_runway_protection_level).flag(said.height_above_runway_known);
    for (const OutputError& error : outputErrors(said, truth))
      row.number(error.known ? error.ratio : kUnknown);
    trace_ << std::endl;
  }

  Options options_;
  Parameters parameters_;
  FaultChoice choice_;
  PendingFile pending_;
  std::ofstream file_, trace_;
};

Failure run(const Options& options) {
  const Expected<Parameters> parameters = parametersOf(options.config);
  if (!parameters) return parameters.error();
  Campaign(options, *parameters).run();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Flies approaches with faults through the chain and counts what misleads, of each output.",
               "inject_faults");
  Options options;
  app.add_option("--csv", options.csv, "rows to write, one per run");
  app.add_option("--trace", options.trace, "rows of every frame to write, to see what a run was misled by");
  app.add_option("--config", options.config, "parameter file of the chain; without it the defaults");
  CLI::Option* dataset =
      app.add_option("--dataset", options.dataset, "dataset folder to spoil; without it the simulator");
  CLI::Option* scenery =
      app.add_option("--scenery", options.scenery,
                     "what is around the simulator's runways; without it grass, and lower flights")
          ->check(CLI::IsMember(sceneryKinds()))
          ->excludes(dataset);
  app.add_flag(
         "--threshold", options.threshold,
         "flights over the threshold in larger images, where x and the height above the runway are known")
      ->excludes(dataset)
      ->excludes(scenery);
  app.add_option("--faults", options.faults, "only these, pairs as a+b; without it all")->delimiter(',');
  app.add_option("--pairs", options.pairs, "pairs of faults besides, for each seed")->capture_default_str();
  app.add_option("--first", options.first, "first seed")->capture_default_str();
  app.add_option("--count", options.count, "how many seeds")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--frames", options.frames, "of a run")->capture_default_str()->check(CLI::Range(25, 1000));
  app.add_flag_callback(
      "--list",
      [] {
        for (const Fault& fault : allFaults()) std::cout << fault.name << '\t' << fault.meaning << '\n';
        throw CLI::Success();
      },
      "print the faults and leave");
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  if (options.csv.empty()) {
    std::cerr << "inject_faults: --csv is required\n";
    return kWrongUsage;
  }
  cv::setNumThreads(1);  // one process per core: run several with different seeds at once
  return exitStatusOf(app, "", [&] { return run(options); });
}
