// Measures the time of each stage and of the whole chain, and of peers on the same frames in the same run.

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "command_line.h"
#include "heap.h"
#include "image_allocations.h"
#include "paper_pipeline.h"
#include "peers.h"
#include "pending_file.h"
#include "resources.h"
#include "searching.h"
#include "sequences.h"
#include "times.h"
#include "uav_landing/parameters/parameter_file.h"
#include "uav_landing/pipeline.h"

namespace {

using namespace uav_landing;
using namespace uav_landing::benchmark;

constexpr size_t kWarmUp = 3;  // pairs whose times do not count: first search, buffers

/// Measurements on one sequence. Names are in the order of their first appearance.
struct Measurement {
  std::string sequence;
  cv::Size size;
  std::vector<std::pair<std::string, Times>> programs, stages;
  // Per pair, in the last quarter, as the pairs before fill the memory: allocations as large as an image, and
  // all by operator new.
  double image_allocations = 0, allocations = 0;
  double peak_memory = 0;                // MB
  std::vector<double> pairs_per_second;  // of 1, 2, ... chains side by side

  static Times& of(std::vector<std::pair<std::string, Times>>& all, const std::string& name) {
    for (auto& [known, times] : all)
      if (known == name) return times;
    return all.emplace_back(name, Times()).second;
  }
  const Times& program(const std::string& name) const {
    return std::find_if(programs.begin(), programs.end(), [&](const auto& p) { return p.first == name; })
        ->second;
  }
};

sensor_msgs::ImageConstPtr toMessage(const cv::Mat& image) {
  return cv_bridge::CvImage({}, sensor_msgs::image_encodings::MONO8, image).toImageMsg();
}

Expected<Measurement> measure(const Sequence& sequence, const Parameters& parameters) {
  Expected<Pipeline> chain = Pipeline::create(sequence.left, sequence.right, parameters);
  if (!chain) return tl::make_unexpected(chain.error());
  for (const std::string& warning : chain->warnings())
    std::cerr << "benchmark: " << sequence.name << ": " << warning << '\n';
  PaperPipeline paper(chain->rig().rig, sequence.left, sequence.right);
  StereoImageProcPeer block(sequence, StereoImageProcPeer::Processor::BM);
  StereoImageProcPeer semi_global(sequence, StereoImageProcPeer::Processor::SGBM);
  const cv::Ptr<cv::StereoMatcher> matcher = cv::StereoBM::create(64, 15);
  cv::Mat disparities;
  ImageFloor floor(sequence);

  Measurement result;
  result.sequence = sequence.name;
  result.size = sequence.left.imageSize();
  result.peak_memory = peakMemory(sequence, parameters);
  result.pairs_per_second = pairsPerSecond(sequence, parameters);
  const size_t counted = sequence.pairs.size() / 4;
  double last = sequence.pairs.front().stamp;
  for (size_t i = 0; i < sequence.pairs.size(); ++i) {
    const Sequence::Pair& pair = sequence.pairs[i];
    const auto run = [&](const char* name, const auto& work) {
      const double start = cpuMilliseconds();
      work();
      const double ms = cpuMilliseconds() - start;
      if (i >= kWarmUp) Measurement::of(result.programs, name).ms.push_back(ms);
    };
    {
      const size_t image = static_cast<size_t>(result.size.area()) / 2;
      const ImageAllocations matrices(image);
      const HeapCounter heap(image);
      run("uav_landing", [&] { chain->process(pair.stamp, pair.left, pair.right); });
      if (i + counted >= sequence.pairs.size()) {
        result.image_allocations += static_cast<double>(matrices.count()) + static_cast<double>(heap.large());
        result.allocations += static_cast<double>(heap.count());
      }
    }
    run("the paper, literally", [&] { paper.process(pair.left, pair.right, pair.stamp - last); });
    const sensor_msgs::ImageConstPtr left = toMessage(pair.left), right = toMessage(pair.right);
    run("stereo_image_proc BM + plane", [&] { block.process(left, right); });
    run("stereo_image_proc SGBM + plane", [&] { semi_global.process(left, right); });
    run("StereoBM alone",
        [&] { matcher->compute(block.rectifiedLeft(), block.rectifiedRight(), disparities); });
    run("image floor", [&] { floor.process(pair.left, pair.right); });
    last = pair.stamp;
  }
  // Stages have a run of their own, so that the peers do not empty the caches between them.
  for (size_t i = 0; i < sequence.pairs.size(); ++i) {
    const Sequence::Pair& pair = sequence.pairs[i];
    const Pipeline::Output& output = chain->process(pair.stamp + 1e3, pair.left, pair.right);
    if (i < kWarmUp) continue;
    for (const auto& [part, ms] : output.parts.parts()) Measurement::of(result.stages, part).ms.push_back(ms);
  }
  result.image_allocations /= static_cast<double>(counted);
  result.allocations /= static_cast<double>(counted);
  return result;
}

/// Slope of log time over log pixels of the simulated sequences, by least squares.
double growth(const std::vector<Measurement>& measurements) {
  std::vector<double> x, y;
  for (const Measurement& m : measurements) {
    if (m.sequence.rfind("simulated", 0) != 0) continue;
    x.push_back(std::log(m.size.area()));
    y.push_back(std::log(m.program("uav_landing").median()));
  }
  if (x.size() < 2) return std::nan("");
  const double n = static_cast<double>(x.size());
  const double mx = std::accumulate(x.begin(), x.end(), 0.0) / n,
               my = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xy = 0, xx = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mx) * (y[i] - my);
    xx += (x[i] - mx) * (x[i] - mx);
  }
  return xy / xx;
}

void printRow(const std::string& name, const Times& times, const char* unit) {
  std::cout << "| " << name << " | " << std::fixed << std::setprecision(2) << times.median() << " | "
            << times.quantile(0.99) << " | " << times.quantile(1) << " | " << unit << " |\n";
}

void print(const Measurement& m) {
  std::cout << "\n### " << m.sequence
            << "\n\n| CPU ms a pair | median | 99 % | worst | uav_landing over it |\n"
            << "|---|---|---|---|---|\n";
  const double own = m.program("uav_landing").median();
  for (const auto& [name, times] : m.programs) {
    std::ostringstream ratio;
    ratio << std::fixed << std::setprecision(2) << own / times.median();
    printRow(name, times, ratio.str().c_str());
  }
  std::cout << "\n| stage, ms | median | 99 % | worst | |\n|---|---|---|---|---|\n";
  for (const auto& [name, times] : m.stages) printRow(name, times, "");
  std::cout << "\nImage-sized allocations a pair: " << m.image_allocations
            << "; all by operator new: " << m.allocations << "\nPeak memory of a chain: " << m.peak_memory
            << " MB\nPairs a second of chains side by side:";
  for (const double rate : m.pairs_per_second) std::cout << " " << rate;
  std::cout << "\n" << std::flush;
}

void print(const std::vector<SearchingTimes>& searching) {
  if (searching.empty()) return;
  std::cout
      << "\n### Searching\n\n| CPU ms a pair, whole sequence | steady | median | 95 % | worst | worst over "
         "steady |\n|---|---|---|---|---|---|\n"
      << std::fixed << std::setprecision(2);
  for (const SearchingTimes& times : searching) {
    std::cout << "| " << times.sequence << " " << times.size.width << "x" << times.size.height << " | "
              << times.steady << " | " << times.pairs.median() << " | " << times.pairs.quantile(0.95) << " | "
              << times.pairs.quantile(1) << " | " << times.worstOverSteady() << " |\n";
  }
  std::cout << std::flush;
}

void write(const std::vector<SearchingTimes>& searching, std::ostream& out) {
  out << "\"searching\": [";
  const char* separator = "\n";
  for (const SearchingTimes& times : searching) {
    out << separator << "{\"name\": \"" << times.sequence << "\", \"width\": " << times.size.width
        << ", \"height\": " << times.size.height << ", \"steady\": " << times.steady << ", ";
    times.pairs.write(out);
    out << ", \"pairs\": [";
    for (size_t i = 0; i < times.pairs.ms.size(); ++i) out << (i > 0 ? ", " : "") << times.pairs.ms[i];
    out << "]}";
    separator = ",\n";
  }
  out << "], ";
}

void writeJson(const std::string& path, const std::vector<Measurement>& measurements,
               const std::vector<SearchingTimes>& searching) {
  PendingFile pending(path);
  std::ofstream out(pending.temporary());
  const auto list = [&out](const std::vector<std::pair<std::string, Times>>& all) {
    const char* separator = "";
    for (const auto& [name, times] : all) {
      out << separator << "\"" << name << "\": {";
      times.write(out);
      out << "}";
      separator = ", ";
    }
  };
  const double slope = growth(measurements);
  out << "{\"growth\": " << (std::isfinite(slope) ? std::to_string(slope) : "null") << ", ";
  write(searching, out);
  out << "\"sequences\": [";
  for (size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    out << (i > 0 ? ",\n" : "\n") << "{\"name\": \"" << m.sequence << "\", \"width\": " << m.size.width
        << ", \"height\": " << m.size.height << ", \"image_allocations\": " << m.image_allocations
        << ", \"allocations\": " << m.allocations
        << ", \"peak_memory_mb\": " << (std::isfinite(m.peak_memory) ? std::to_string(m.peak_memory) : "null")
        << ", \"pairs_per_second\": [";
    for (size_t k = 0; k < m.pairs_per_second.size(); ++k)
      out << (k > 0 ? ", " : "") << m.pairs_per_second[k];
    out << "], \"programs\": {";
    list(m.programs);
    out << "}, \"stages\": {";
    list(m.stages);
    out << "}}";
  }
  out << "\n]}\n";
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
  pending.commit();
}

struct Options {
  std::string config = UAV_LANDING_SOURCE_DIR "/config/simulator/full_scale.yaml", parameters, json;
  std::vector<int> widths = {320, 640, 1280, 2560};
  std::vector<std::string> datasets, searching;
  std::string steady = UAV_LANDING_SOURCE_DIR "/config/simulator/demo.yaml";
  int pairs = 60;
};

Failure run(const Options& options) {
  Parameters parameters;
  if (!options.parameters.empty()) {
    const Expected<Parameters> loaded = loadParameterFile(options.parameters);
    if (!loaded) return loaded.error();
    parameters = *loaded;
  }
  std::vector<Measurement> measurements;
  const auto take = [&](const Expected<Sequence>& sequence) -> Failure {
    if (!sequence) return sequence.error();
    if (sequence->pairs.size() <= kWarmUp)
      return {Reason::kInputInvalid, sequence->name + " has too few pairs"};
    const Expected<Measurement> measured = measure(*sequence, parameters);
    if (!measured) return measured.error();
    print(*measured);
    measurements.push_back(*measured);
    return {};
  };
  for (const int width : options.widths)
    if (const Failure failure = take(simulatedSequence(options.config, width, options.pairs))) return failure;
  for (const std::string& folder : options.datasets)
    if (const Failure failure = take(recordedSequence(folder, options.pairs))) return failure;
  std::vector<SearchingTimes> searching;
  for (const std::string& input : options.searching) {
    const Expected<Sequence> sequence = std::filesystem::path(input).extension() == ".yaml"
                                            ? wholeApproach(input)
                                            : recordedSequence(input, std::numeric_limits<int>::max());
    if (!sequence) return sequence.error();
    const Expected<SearchingTimes> times = measureSearching(*sequence, options.steady, parameters);
    if (!times) return times.error();
    searching.push_back(*times);
  }
  print(searching);
  std::cout << "\nTime grows with pixels to the power of " << growth(measurements) << "\n";
  if (!options.json.empty()) writeJson(options.json, measurements, searching);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures the CPU time of every stage and of the chain, with peers on the same frames.",
               "benchmark");
  Options options;
  app.add_option("--simulate", options.config, "what the simulator shows")->capture_default_str();
  app.add_option("--widths", options.widths, "of the simulated images, px")->capture_default_str();
  app.add_option("--datasets", options.datasets, "dataset folders to measure on as well");
  app.add_option("--searching", options.searching,
                 "the simulator's files and dataset folders to measure pair by pair, from the first one on");
  app.add_option("--steady", options.steady,
                 "the simulator's file with the flight that these are compared with")
      ->capture_default_str();
  app.add_option("--pairs", options.pairs, "of each sequence")
      ->capture_default_str()
      ->check(CLI::Range(4, 10000));
  app.add_option("--config", options.parameters, "parameters of the chain; else the defaults");
  app.add_option("--json", options.json, "file to write the numbers to");
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  cv::setNumThreads(1);
  return exitStatusOf(app, "", [&] { return run(options); });
}
