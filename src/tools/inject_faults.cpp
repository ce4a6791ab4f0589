// Flies simulated approaches or a dataset through the chain with one or two faults from a random moment on,
// and counts what was available, what was misleading and how long until it was noticed.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

#include "camera_info.h"
#include "command_line.h"
#include "csv_row.h"
#include "dataset.h"
#include "fault_score.h"
#include "faults.h"
#include "pending_file.h"
#include "progress_bar.h"
#include "random_approach.h"
#include "uav_landing/integrity/stamp_order.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/attitude.h"
#include "uav_landing/simulator/ground_profile.h"

namespace {

using namespace uav_landing;

struct Options {
  std::string config, csv, dataset, trace;
  std::vector<std::string> faults;
  uint64_t first = 1;
  int count = 10, frames = 70, pairs = 0;
};

constexpr const char* kHeader =
    "source,seed,faults,onset_s,healthy,healthy_valid,healthy_misleading,faulted,faulted_valid,beyond_level,"
    "beyond_limit,misleading,time_to_alert_s,worst_level_ratio,worst_limit_ratio,alarm,healthy_uncertain,"
    "healthy_tests";
constexpr const char* kTraceHeader =
    "source,seed,faults,time_s,faulted,true_height_m,height_m,valid,protection_level_m,protection_source,"
    "alert_limit_m,raw_height_m,status,reason,failed_tests";

using Combination = std::vector<const Fault*>;

std::string nameOf(const Combination& faults) {
  std::string name;
  for (const Fault* fault : faults) name += (name.empty() ? "" : "+") + fault->name;
  return name;
}

/// What is painted on the ground is painted on a plane: on ground of another shape it would be a picture of
/// that plane, and not of the ground that the height is above.
bool exclude(const Fault& a, const Fault& b) {
  const auto bends = [](const Fault& fault) {
    SimulatorParameters changed;
    if (fault.build) fault.build(changed);
    return !GroundProfile(changed.profile).flat();
  };
  const auto paints = [](const Fault& fault) { return fault.needs_scene && fault.spoil; };
  return (bends(a) && paints(b)) || (bends(b) && paints(a));
}

/// A rig and heights that a small image can do: 320 x 240 with a baseline of 2 m, as good as 640 x 480 with 1
/// m.
SimulatorParameters drawFlight(uint64_t seed, int frames, const Parameters& parameters) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 1);
  // At the end of the run. From higher up most healthy frames would not be certain enough to be valid, so
  // that a fault has nothing to mislead.
  const double height = 3 * std::pow(4.0, random.uniform(0.0, 1.0));
  SimulatorParameters p = drawSnippet(seed * 1000003, height, frames, parameters);
  p.image.width = 320;
  p.image.height = 240;
  for (SimulatedCameraParameters* camera : {&p.left_camera, &p.right_camera}) {
    camera->fx = camera->fy = 277.13;
    camera->cx = 159.5;
    camera->cy = 119.5;
  }
  p.rig.x = 2;
  return p;
}

/// Time from which on the ground below was in view before, by a whole matching window: what it is like before
/// that changes no pixel that a run begins with.
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

struct SimulatedFlight {
  SimulatedFlight(const ApproachSimulator& simulator, const GroundProfile& profile) : rig(simulator.rig()) {
    flight.left = rig.left.calibration;
    flight.right = rig.right.calibration;
    flight.rig = &rig;
    for (int i = 0; i < simulator.frames(); ++i) {
      ApproachSimulator::Frame frame = simulator.frame(i);
      flight.frames.push_back({frame.time, frame.left, frame.right, frame.truth, simulator.pose(frame.time)});
    }
    if (!profile.flat()) flight.settled = std::max(flight.settled, timeOfKnownGround(flight, profile));
  }
  CameraRig rig;
  Flight flight;
};

std::string withoutCommas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

std::unique_ptr<SimulatedFlight> simulate(const SimulatorParameters& drawn) {
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(drawn);
  if (!simulator) return nullptr;  // a scene that a fault has put in the aircraft's way
  return std::make_unique<SimulatedFlight>(*simulator, GroundProfile(drawn.profile));
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

/// So many frames of it, from this one on.
Flight cut(const Flight& whole, int first, int frames) {
  Flight part{whole.left, whole.right, whole.rig, {}};
  const auto begin = whole.frames.begin() + first;
  part.frames.assign(begin, begin + frames);
  return part;
}

/// in_flight: first frame with the faults that come in flight.
Delivery deliver(FaultRun& run, const Combination& faults, int in_flight, int frame) {
  const Flight::Frame& source = run.flight.frames[static_cast<size_t>(frame)];
  Delivery pair{source.time, source.left.clone(), source.right.clone(), true};
  for (const Fault* fault : faults) {
    run.onset = fault->from_first ? 0 : in_flight;
    if (fault->spoil && frame >= run.onset) fault->spoil(run, frame, pair);
  }
  return pair;
}

/// The true height at any time between the frames: stamps and pictures may be those of others.
double trueHeight(const Flight& flight, double time) {
  const auto& frames = flight.frames;
  size_t next = 1;
  while (next + 1 < frames.size() && frames[next].time < time) ++next;
  const Flight::Frame &a = frames[next - 1], &b = frames[next];
  return a.truth.height + (time - a.time) / (b.time - a.time) * (b.truth.height - a.truth.height);
}

/// After each pair that counts: what was said, the true height, whether the fault was there.
using Observer = std::function<void(double time, const LandingResult&, double true_height, bool faulted)>;

constexpr double kStart = 100;  // stamp of the first pair, s

/// Faults are scored from the frame onset on.
FaultScore fly(const Flight& flight, const Combination& faults, int in_flight, int onset, uint64_t seed,
               const Parameters& parameters, const Observer& observe) {
  CameraCalibration left = flight.left, right = flight.right;
  for (const Fault* fault : faults)
    if (fault->calibrate) fault->calibrate(left, right);
  FaultScore score;
  Expected<Pipeline> pipeline = Pipeline::create(left, right, parameters);
  if (!pipeline) {
    score.alarm = "refused: " + pipeline.error().detail;
    return score;
  }
  FaultRun run{flight, in_flight, cv::RNG(seed)};
  double last = flight.frames.front().time;
  StampOrder order(parameters.rectify.max_late);
  for (int frame = 0; frame < static_cast<int>(flight.frames.size()); ++frame) {
    const Delivery pair = deliver(run, faults, in_flight, frame);
    const double now = flight.frames[static_cast<size_t>(frame)].time;
    // Nothing is published without a pair: what was said last is as old as max_age at most, then it is lost.
    if (!pair.delivered) continue;
    // As where images are paired.
    const StampOrder::Arrival arrival = order.follow(std::llround(1e9 * (kStart + pair.time)));
    if (arrival == StampOrder::Arrival::kRepeated || arrival == StampOrder::Arrival::kLate) continue;
    const Pipeline::Output& output = pipeline->process(kStart + pair.time, pair.left, pair.right);
    if (now - flight.frames.front().time < flight.settled) continue;
    const double height = trueHeight(flight, pair.time);
    score.take(output.landing, height, frame >= onset, now - last);
    if (observe) observe(now, output.landing, height, frame >= onset);
    last = now;
  }
  return score;
}

class Campaign {
 public:
  Campaign(const Options& options, const Parameters& parameters)
      : options_(options), parameters_(parameters), pending_(options.csv), file_(pending_.temporary()) {
    if (!file_) throw std::runtime_error(options.csv + ": cannot be written");
    file_ << kHeader << '\n';
    if (!options.trace.empty()) {
      trace_.open(options.trace);
      if (!trace_) throw std::runtime_error(options.trace + ": cannot be written");
      trace_ << kTraceHeader << '\n';
    }
    chooseFaults();
  }

  void run() {
    const Flight recorded = options_.dataset.empty() ? Flight() : readFlight(options_.dataset);
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
  void chooseFaults() {
    const bool simulated = options_.dataset.empty();
    std::set<std::string> wanted;
    for (const std::string& name : options_.faults)
      name.find('+') == std::string::npos ? (void)wanted.insert(name) : choosePair(name);
    std::set<std::string> unknown = wanted;
    for (const Fault& fault : allFaults()) {
      unknown.erase(fault.name);
      const bool asked = options_.faults.empty() || wanted.count(fault.name) > 0;
      if (asked && (!fault.needs_scene || simulated)) faults_.push_back(&fault);
    }
    if (!unknown.empty()) throw std::runtime_error("there is no fault " + *unknown.begin());
  }

  /// "a+b", in the order of the places along the light's way.
  void choosePair(const std::string& names) {
    Combination pair;
    for (const Fault& fault : allFaults())
      if (("+" + names + "+").find("+" + fault.name + "+") != std::string::npos) pair.push_back(&fault);
    std::sort(pair.begin(), pair.end(), [](const Fault* a, const Fault* b) { return a->place < b->place; });
    if (pair.size() != 2) throw std::runtime_error(names + " is no pair of faults");
    const bool drawn = pair[0]->needs_scene || pair[1]->needs_scene;
    if (options_.dataset.empty() || !drawn) asked_pairs_.push_back(pair);
  }

  /// Each fault alone, the pairs asked for, and some pairs drawn by the seed.
  std::vector<Combination> combinations(uint64_t seed) const {
    std::vector<Combination> all = asked_pairs_;
    for (const Fault* fault : faults_) all.push_back({fault});
    cv::RNG random(seed * 77 + 5);
    // Those that come in flight are drawn; what they are from the first pair on is flown alone or when asked.
    std::vector<const Fault*> drawn = faults_;
    drawn.erase(
        std::remove_if(drawn.begin(), drawn.end(), [](const Fault* fault) { return fault->from_first; }),
        drawn.end());
    const int count = static_cast<int>(drawn.size());
    for (int i = 0; i < options_.pairs && count > 2; ++i) {
      const Fault* first = drawn[static_cast<size_t>(random.uniform(1, count))];
      const Fault* second = drawn[static_cast<size_t>(random.uniform(1, count))];
      if (first == second || first->name == "none" || second->name == "none") continue;
      if (exclude(*first, *second)) continue;
      if (first->place > second->place) std::swap(first, second);
      all.push_back({first, second});
    }
    return all;
  }

  void flySimulated(uint64_t seed) {
    const SimulatorParameters drawn = drawFlight(seed, options_.frames, parameters_);
    const auto plain = simulate(drawn);
    if (!plain) return;
    std::map<std::string, std::unique_ptr<SimulatedFlight>> others;  // by the faults that change the scene
    for (const Combination& faults : combinations(seed)) {
      SimulatorParameters changed = drawn;
      Combination builders;
      for (const Fault* fault : faults) {
        if (!fault->build) continue;
        fault->build(changed);
        builders.push_back(fault);
      }
      const std::string name = nameOf(builders);
      if (!builders.empty() && others.count(name) == 0) others[name] = simulate(changed);
      const SimulatedFlight* flight = builders.empty() ? plain.get() : others[name].get();
      if (flight != nullptr) flyOne(flight->flight, "simulator", faults, seed);
    }
  }

  void flyRecorded(const Flight& recorded, uint64_t seed) {
    const int frames = std::min(options_.frames, static_cast<int>(recorded.frames.size()));
    cv::RNG random(seed * 1234567 + 3);
    const int first = random.uniform(0, static_cast<int>(recorded.frames.size()) - frames + 1);
    const Flight part = cut(recorded, first, frames);
    const Combination healthy = {&allFaults().front()};
    std::string name = options_.dataset;
    while (!name.empty() && name.back() == '/') name.pop_back();
    name = name.substr(name.find_last_of('/') + 1);
    // Without a fault the whole of it: pieces would have frames in common.
    for (const Combination& faults : combinations(seed))
      flyOne(faults == healthy ? recorded : part, name, faults, seed);
  }

  void flyOne(const Flight& flight, const std::string& source, const Combination& faults, uint64_t seed) {
    const int frames = static_cast<int>(flight.frames.size());
    uint64_t hash = seed;
    for (const char letter : nameOf(faults)) hash = hash * 31 + static_cast<unsigned char>(letter);
    cv::RNG random(hash);
    const bool whole =
        std::any_of(faults.begin(), faults.end(), [](const Fault* f) { return f->wholeRun(); });
    const bool healthy = faults.size() == 1 && faults[0]->name == "none";
    // Late enough for the chain to have settled, early enough to see what becomes of it after a restart.
    const int in_flight = random.uniform(frames * 5 / 20, frames * 7 / 20);
    const int onset = healthy ? frames : whole ? 0 : in_flight;
    const std::string from = source + "," + std::to_string(seed) + "," + nameOf(faults);
    const Observer observe = [&](double time, const LandingResult& said, double height, bool faulted) {
      trace(from, time, said, height, faulted);
    };
    const FaultScore score =
        fly(flight, faults, in_flight, onset, hash, parameters_, trace_.is_open() ? observe : Observer());
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
    file_ << std::endl;  // what is there already can be looked at
  }

  void trace(const std::string& from, double time, const LandingResult& said, double height, bool faulted) {
    CsvRow row(trace_);
    row.text(from).number(time).flag(faulted).number(height).number(said.height).flag(said.height_valid);
    row.number(said.height_protection_level).text(said.protection_source).number(said.height_alert_limit);
    row.number(said.raw_height).text(toString(said.status)).text(toString(said.failure.reason));
    row.text(failedTests(said.tests));
    trace_ << std::endl;
  }

  Options options_;
  Parameters parameters_;
  std::vector<const Fault*> faults_;
  std::vector<Combination> asked_pairs_;
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
  CLI::App app("Flies approaches with faults through the chain and counts misleading heights.",
               "inject_faults");
  Options options;
  app.add_option("--csv", options.csv, "rows to write, one per run");
  app.add_option("--trace", options.trace, "rows of every frame to write, to see what a run was misled by");
  app.add_option("--config", options.config, "parameter file of the chain; without it the defaults");
  app.add_option("--dataset", options.dataset, "dataset folder to spoil; without it the simulator");
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
