// Measures what the nodelets take besides the chain's own work: latency from a pair to its estimate, compared
// with the chain's time on the same pair in the same run; memory; copies; and CPU time while nobody listens.

#include <ros/ros.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "command_line.h"
#include "copied_bytes.h"
#include "heap.h"
#include "image_allocations.h"
#include "nodelet_chain.h"
#include "pending_file.h"
#include "sequences.h"
#include "times.h"
#include "uav_landing/pipeline.h"

namespace {

using namespace uav_landing;
using namespace uav_landing::benchmark;
using Clock = std::chrono::steady_clock;

// Pairs that do not count: first search, pools and buffers that grow, the frames of the sliding window.
constexpr size_t kWarmUp = 30;

double milliseconds(Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

/// Cost of one way of processing for the pairs that count.
struct Cost {
  Times times;
  double image_allocations = 0, allocations = 0, copied = 0;  // sums

  /// work: returns its time.
  template <class Work>
  void measure(size_t pair, size_t pixels, const Work& work) {
    const ImageAllocations matrices(pixels / 2);
    const HeapCounter heap(pixels / 2);
    const size_t before = copiedBytes();
    const Clock::duration time = work();
    if (pair < kWarmUp) return;
    times.ms.push_back(milliseconds(time));
    copied += static_cast<double>(copiedBytes() - before);
    image_allocations += static_cast<double>(matrices.count()) + static_cast<double>(heap.large());
    allocations += static_cast<double>(heap.count());
  }
  double perPair(double sum) const { return sum / static_cast<double>(times.ms.size()); }

  void print(const char* name) const {
    std::cout << "| " << name << " | " << std::fixed << std::setprecision(2) << times.median() << " | "
              << times.quantile(0.99) << " | " << times.quantile(1) << " | " << perPair(image_allocations)
              << " | " << std::setprecision(0) << perPair(allocations) << " | " << perPair(copied) / 1024
              << " |\n";
  }
  void write(std::ostream& out, const char* name) const {
    out << "\"" << name << "\": {";
    times.write(out);
    out << ", \"image_allocations\": " << perPair(image_allocations)
        << ", \"allocations\": " << perPair(allocations) << ", \"copied_bytes\": " << perPair(copied) << "}";
  }
};

struct Measurement {
  Cost nodelets, chain;
  size_t pairs = 0;       // all, including the first ones
  size_t late = 0;        // pairs whose estimate took longer than a period
  double idle_share = 0;  // CPU time over wall-clock time while nobody subscribes
};

struct Options {
  std::string config = UAV_LANDING_SOURCE_DIR "/config/simulator/full_scale.yaml", dataset, json;
  int width = 640, pairs = 90;
  double rate = 20, idle = 5;
};

Clock::duration period(const Options& options) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options.rate));
}

/// CPU time of this process over wall-clock time while pairs come and nobody wants an estimate.
double idleShare(NodeletChain& nodelets, const Sequence& sequence, const Options& options) {
  const NodeletChain::Pair pair =
      NodeletChain::message(sequence, 0, ros::Time(sequence.pairs[0].stamp + 1e3));
  const auto start = Clock::now();
  const double cpu = cpuMilliseconds();
  for (auto slot = start; slot - start < std::chrono::duration<double>(options.idle);
       slot += period(options)) {
    std::this_thread::sleep_until(slot);
    nodelets.publish(pair);
  }
  return (cpuMilliseconds() - cpu) / milliseconds(Clock::now() - start);
}

Measurement measure(const Sequence& sequence, Pipeline& chain, const Options& options) {
  NodeletChain nodelets(sequence);
  nodelets.listen(sequence, 1);  // not with the first pair, because a repeated one is skipped
  Measurement result;
  auto slot = Clock::now();
  for (size_t i = 0; i < sequence.pairs.size(); ++i, slot += period(options)) {
    const Sequence::Pair& pair = sequence.pairs[i];
    const NodeletChain::Pair message = NodeletChain::message(sequence, i, ros::Time(pair.stamp));
    std::this_thread::sleep_until(slot);
    result.nodelets.measure(i, pair.left.total(), [&] {
      const Clock::duration time = nodelets.process(message);
      ++result.pairs;
      if (time > period(options)) ++result.late;
      return time;
    });
    // The nodelets have finished it; now the chain itself processes the same pair.
    result.chain.measure(i, pair.left.total(), [&] {
      const auto start = Clock::now();
      chain.process(pair.stamp, pair.left, pair.right);
      return Clock::now() - start;
    });
  }
  nodelets.stopListening();
  result.idle_share = idleShare(nodelets, sequence, options);
  return result;
}

void print(const Measurement& m, const std::string& sequence, double rate) {
  std::cout << "\n### " << sequence << " at " << rate << " Hz\n\n"
            << "| wall clock, ms | median | 99 % | worst | image-sized allocations | all by operator new | "
               "kB copied |\n"
            << "|---|---|---|---|---|---|---|\n";
  m.nodelets.print("from the camera's messages to the estimate");
  m.chain.print("the chain itself");
  std::cout << "\nLatency over the chain's own time, median: " << std::setprecision(2)
            << m.nodelets.times.median() / m.chain.times.median()
            << "\nPairs that took longer than a period, the first ones included: " << m.late << " of "
            << m.pairs << "\nCPU time while nobody subscribes: " << 100 * m.idle_share << " % of a core\n";
}

void writeJson(const Measurement& m, const std::string& sequence, const Options& options) {
  PendingFile pending(options.json);
  std::ofstream out(pending.temporary());
  out << "{\"sequence\": \"" << sequence << "\", \"rate\": " << options.rate << ",\n";
  m.nodelets.write(out, "nodelets");
  out << ",\n";
  m.chain.write(out, "chain");
  out << ",\n\"pairs\": " << m.pairs << ", \"late_pairs\": " << m.late
      << ",\n\"idle_cpu_share\": " << m.idle_share << "}\n";
  out.close();
  if (!out) throw std::runtime_error(options.json + ": cannot be written");
  pending.commit();
}

Failure run(const Options& options) {
  const Expected<Sequence> sequence = options.dataset.empty()
                                          ? simulatedSequence(options.config, options.width, options.pairs)
                                          : recordedSequence(options.dataset, options.pairs);
  if (!sequence) return sequence.error();
  if (sequence->pairs.size() <= kWarmUp)
    return {Reason::kInputInvalid, sequence->name + " has too few pairs"};
  Expected<Pipeline> chain = Pipeline::create(sequence->left, sequence->right, Parameters());
  if (!chain) return chain.error();
  for (const std::string& warning : chain->warnings())
    std::cerr << "nodelet_benchmark: " << sequence->name << ": " << warning << '\n';
  if (!ros::master::check())
    return {Reason::kInputInvalid,
            "no ROS master: start roscore, or use roslaunch uav_landing nodelet_benchmark.launch"};
  const Measurement measured = measure(*sequence, *chain, options);
  print(measured, sequence->name, options.rate);
  if (!options.json.empty()) writeJson(measured, sequence->name, options);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "nodelet_benchmark");
  CLI::App app("Measures what the nodelets take besides the chain's own work. Needs a ROS master.",
               "nodelet_benchmark");
  Options options;
  app.add_option("--simulate", options.config, "what the simulator shows")->capture_default_str();
  app.add_option("--width", options.width, "of the simulated images, px")->capture_default_str();
  app.add_option("--dataset", options.dataset, "dataset folder instead of the simulator");
  app.add_option("--pairs", options.pairs, "of the sequence")
      ->capture_default_str()
      ->check(CLI::Range(static_cast<int>(kWarmUp) + 2, 10000));
  app.add_option("--rate", options.rate, "of the cameras, Hz")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--idle", options.idle, "time without a subscriber, s")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--json", options.json, "file to write the numbers to");
  if (const auto status = parseCommandLine(app, argc, argv)) return *status;
  cv::setNumThreads(1);
  return exitStatusOf(app, "", [&] { return run(options); });
}
