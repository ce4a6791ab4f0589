#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace uav_landing {

/// Wall-clock time of a stage's parts for one pair, in order of execution (the paper's Table 1).
class Timings {
 public:
  /// Adds milliseconds to the part of this name.
  void add(const char* part, double ms);
  void clear() { parts_.clear(); }
  double total() const;
  const std::vector<std::pair<std::string, double>>& parts() const { return parts_; }

 private:
  std::vector<std::pair<std::string, double>> parts_;
};

/// Measures the time of its scope and adds it to one part.
class ScopedTimer {
 public:
  ScopedTimer(Timings& timings, const char* part)
      : timings_(timings), part_(part), start_(std::chrono::steady_clock::now()) {}
  ~ScopedTimer() {
    timings_.add(
        part_, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
  }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  Timings& timings_;
  const char* part_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace uav_landing
