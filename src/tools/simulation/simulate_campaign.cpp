// Flies many random simulated approaches through the chain, in this process, and writes truth beside
// estimate.

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "command_line.h"
#include "progress_bar.h"
#include "simulation/campaign_csv.h"
#include "simulation/random_approach.h"
#include "simulator/ground/ground_profile.h"
#include "uav_landing/motion/imu_buffer.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace {

using namespace uav_landing;

constexpr int kSnippet = 13;          // frames
constexpr double kOneMessage = 0.01;  // s, between messages of the slowest inertial sensor that is drawn

struct Options {
  std::string config, csv, kind = "snippets";
  uint64_t first = 1;
  int count = 20;
  std::optional<int> frames;
  bool imu = false, bend = false, scenery = false, rolling_shutter = false, vibration = false, chart = false;
  std::vector<double> noise = {1, 2, 5}, heights = {3, 10, 30};
};

template <class T>
T orThrow(Expected<T>&& value, uint64_t seed) {
  if (value) return std::move(*value);
  throw std::runtime_error("seed " + std::to_string(seed) + ": " + value.error().message());
}

/// One chain that sees a flight.
struct Viewer {
  Pipeline pipeline;
  double noise;
  bool chart;
};

/// A chain for each noise level, and again with the runway's size given when the options ask for it.
std::vector<Viewer> viewersOf(const Options& options, const SimulatorParameters& drawn, const CameraRig& rig,
                              Parameters parameters, uint64_t seed) {
  std::vector<Viewer> viewers;
  for (const bool chart : {false, true}) {
    if (chart && !options.chart) continue;
    if (chart) {
      parameters.runway.width = drawn.runway.width;
      parameters.runway.length = drawn.runway.length;
    }
    for (const double noise : options.noise)
      viewers.push_back(
          {orThrow(Pipeline::create(rig.left.calibration, rig.right.calibration, parameters), seed), noise,
           chart});
  }
  return viewers;
}

/// True height above the runway, m; unknown where the runway is not level.
double heightAboveRunway(const SimulatorParameters& drawn, const CameraPose& pose) {
  const GroundProfile profile(drawn.profile);
  const bool level = profile.height(0) == 0 && profile.height(drawn.runway.length) == 0;
  return level ? pose.position.z() : kUnknown;
}

/// Runs one flight through several chains. The view of the cameras is rendered once. For every frame and
/// chain it calls visit(sample, frame's truth, output).
template <class Visitor>
void fly(const Options& options, const SimulatorParameters& drawn, Parameters parameters,
         CampaignCsv::Sample sample, Visitor&& visit) {
  // A flight of a few frames should show what comes after the search.
  parameters.stereo_depth.search_at_once = parameters.approach_angle.search_at_once = true;
  parameters.rig.readout_time = drawn.image.readout_time;
  parameters.rig.stamp_row = drawn.image.stamp_row;
  const auto simulator = orThrow(ApproachSimulator::create(drawn), sample.seed);
  ImuBuffer imu(parameters.approach_angle, leftRowSpan(parameters.rig));
  int heard = 0;
  std::vector<Viewer> viewers = viewersOf(options, drawn, simulator.rig(), parameters, sample.seed);
  for (const std::string& warning : viewers.front().pipeline.warnings())
    std::cerr << "simulate_campaign: seed " << sample.seed << ": " << warning << '\n';
  for (sample.frame = 0; sample.frame < simulator.frames(); ++sample.frame) {
    const ApproachSimulator::Light light = simulator.light(sample.frame);
    sample.time = simulator.timeOf(sample.frame);
    sample.height_above_runway = heightAboveRunway(drawn, simulator.pose(sample.time));
    std::optional<double> before;
    if (sample.frame > 0) before = simulator.timeOf(sample.frame - 1);
    // The last rows are exposed after the stamp, and a pair waits for the message after them.
    const double end = sample.time + std::abs(drawn.image.readout_time) + kOneMessage;
    while (heard < simulator.imu().count(end)) imu.add(simulator.imu().sample(heard++));
    const AttitudePrior prior = imu.at(sample.time, before, opticalFromImu());
    for (Viewer& viewer : viewers) {
      const ApproachSimulator::Frame frame = simulator.expose(light, viewer.noise);
      sample.noise = viewer.noise;
      sample.chart = viewer.chart;
      // A stamp of 0 would mean that there is none.
      visit(sample, frame.truth,
            viewer.pipeline.process(100 + sample.time, frame.left, frame.right, 0, prior));
    }
  }
}

/// Draws the options that come on top of the flight.
void drawMore(const Options& options, uint64_t seed, SimulatorParameters& drawn) {
  if (options.scenery) drawScenery(seed, drawn);
  if (options.rolling_shutter) drawRollingShutter(seed, drawn);
  if (options.vibration) drawVibration(seed, drawn);
}

/// Last frames of snippets that end at each of the heights.
void flySnippets(const Options& options, const Parameters& parameters, CampaignCsv& csv) {
  const int frames = options.frames.value_or(kSnippet);
  ProgressBar progress(options.count * options.heights.size());
  for (uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    for (const double height : options.heights) {
      // Another flight at every height, so that the cells are independent of each other.
      const uint64_t flight = seed * 1000003 + static_cast<uint64_t>(std::llround(100 * height));
      SimulatorParameters drawn = drawSnippet(flight, height, frames, parameters, options.imu);
      if (options.bend) bendGround(flight, parameters, drawn);
      drawMore(options, flight, drawn);
      CampaignCsv::Sample sample;
      sample.seed = seed;
      sample.cell_height = height;
      fly(options, drawn, parameters, sample, [&](const auto& at, const auto& truth, const auto& out) {
        if (at.frame == frames - 1) csv.write(at, drawn, truth, out);
      });
      progress.step();
    }
  }
}

/// Every frame of whole approaches.
void flyApproaches(const Options& options, const Parameters& parameters, CampaignCsv& csv) {
  ProgressBar progress(options.count);
  for (uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    SimulatorParameters drawn =
        options.kind == "far" ? drawFarApproach(seed) : drawApproach(seed, parameters, options.imu);
    if (options.frames)
      drawn.path.duration = std::min(drawn.path.duration, (*options.frames - 1) / drawn.path.rate);
    drawMore(options, seed, drawn);
    CampaignCsv::Sample sample;
    sample.seed = seed;
    fly(options, drawn, parameters, sample,
        [&](const auto& at, const auto& truth, const auto& out) { csv.write(at, drawn, truth, out); });
    progress.step();
  }
}

Failure run(const Options& options) {
  const Expected<Parameters> parameters = parametersOf(options.config);
  if (!parameters) return parameters.error();
  CampaignCsv csv(options.csv);
  if (options.kind == "snippets")
    flySnippets(options, *parameters, csv);
  else
    flyApproaches(options, *parameters, csv);
  csv.finish();
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Flies random simulated approaches through the chain and writes truth beside estimate.",
               "simulate_campaign");
  Options options;
  app.add_option(
         "kind", options.kind,
         "snippets: the last frame of short pieces, one row each; approaches: every frame of whole ones from "
         "60 m to the flare; far: every frame of approaches from 3 to 5 km before the threshold")
      ->check(CLI::IsMember({"snippets", "approaches", "far"}))
      ->required();
  app.add_option("--csv", options.csv, "rows to write")->required();
  app.add_option("--config", options.config, "parameter file of the chain; without it the defaults");
  app.add_option("--first", options.first, "first seed")->capture_default_str();
  app.add_option("--count", options.count, "how many seeds")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--noise", options.noise,
                 "1 sigma of the sensors' noise, grey levels; each seed is flown at all")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 50.0));
  app.add_option("--heights", options.heights, "at which snippets end, m; each seed is flown at all")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 1000.0));
  app.add_option("--frames", options.frames,
                 "of a snippet, at 20 Hz (default 13); of an approach only the first ones (default all)")
      ->check(CLI::Range(2, 100000));
  app.add_flag("--imu", options.imu, "an inertial sensor flies along, with errors drawn, too");
  app.add_flag(
      "--bend", options.bend,
      "the ground of snippets has a vertical curve, as often and by as much as the chain is told to expect");
  app.add_flag(
      "--scenery", options.scenery,
      "fields, towns, water, roads, other runways and the own nose are drawn around each runway, too");
  app.add_flag("--rolling-shutter", options.rolling_shutter,
               "the rows of both cameras have times of their own; how long they take and which of them the "
               "stamp belongs to is drawn, too");
  app.add_flag("--vibration", options.vibration,
               "the rig is shaken; frequency and amplitudes are drawn, too");
  app.add_flag("--chart", options.chart,
               "each seed is flown once more with the runway's width and length given (column chart)");
  app.callback([&options] {
    if (options.bend && options.kind != "snippets") throw CLI::ValidationError("--bend", "for snippets only");
    if (options.imu && options.kind == "far")
      throw CLI::ValidationError("--imu", "for snippets and approaches only");
  });
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  cv::setNumThreads(1);  // one process per core: run several with different seeds at once
  return exitStatusOf(app, "", [&] { return run(options); });
}
