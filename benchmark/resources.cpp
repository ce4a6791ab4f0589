#include "resources.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "uav_landing/pipeline.h"

namespace uav_landing {
namespace benchmark {
namespace {

/// A line of /proc/self/status, kB; NaN when it does not exist.
double statusOf(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name + ":", 0) != 0) continue;
    double kilobytes = std::nan("");
    std::istringstream(line.substr(name.size() + 1)) >> kilobytes;
    return kilobytes;
  }
  return std::nan("");
}

/// Resets the system's peak of the resident memory to the present value.
bool resetPeak() {
  std::ofstream command("/proc/self/clear_refs");
  command << "5";
  return static_cast<bool>(command.flush());
}

Pipeline chainFor(const Sequence& sequence, const Parameters& parameters) {
  return Pipeline::create(sequence.left, sequence.right, parameters).value();
}

void process(Pipeline& chain, const Sequence& sequence) {
  for (const Sequence::Pair& pair : sequence.pairs) chain.process(pair.stamp, pair.left, pair.right);
}

}  // namespace

double peakMemory(const Sequence& sequence, const Parameters& parameters) {
  malloc_trim(0);  // free memory would hide what the chain takes
  if (!resetPeak()) return std::nan("");
  const double before = statusOf("VmRSS");
  Pipeline chain = chainFor(sequence, parameters);
  process(chain, sequence);
  return (statusOf("VmHWM") - before) / 1024;
}

std::vector<double> pairsPerSecond(const Sequence& sequence, const Parameters& parameters) {
  constexpr unsigned kMost = 4;
  std::vector<double> rates;
  for (unsigned count = 1; count <= std::clamp(std::thread::hardware_concurrency(), 1U, kMost); ++count) {
    std::vector<Pipeline> chains;
    for (unsigned i = 0; i < count; ++i) chains.push_back(chainFor(sequence, parameters));
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (Pipeline& chain : chains) threads.emplace_back([&] { process(chain, sequence); });
    for (std::thread& thread : threads) thread.join();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    rates.push_back(static_cast<double>(count * sequence.pairs.size()) / seconds.count());
  }
  return rates;
}

}  // namespace benchmark
}  // namespace uav_landing
