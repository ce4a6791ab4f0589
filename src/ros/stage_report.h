#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/time.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "input_watch.h"

namespace uav_landing {

/// Rates, times and failures of a nodelet since the last diagnostics. Thread safe.
class StageReport {
 public:
  /// Counts a pair that was served. stamp: of its left image. compute_ms: time that it took. reason: why
  /// there is no result, or "".
  void served(const ros::Time& stamp, double compute_ms, const std::string& reason);
  /// Counts pairs that were dropped because newer ones were waiting.
  void dropped(uint64_t count = 1);
  /// Sets all warnings that hold from now on. Returns those that are new.
  std::vector<std::string> warned(const std::vector<std::string>& warnings);
  /// Counts an input that could not be used. problem: what is wrong with it.
  void refused(const std::string& problem);

  /// Writes summary and values for the time since the last call, and starts anew.
  /// inputs: counts of what is paired here.
  /// subscribed: time since the inputs were subscribed, s; none when nobody wants the output.
  void write(diagnostic_updater::DiagnosticStatusWrapper& status,
             const std::vector<InputWatch::Input>& inputs, std::optional<double> subscribed);

 private:
  struct Counts {
    uint64_t served = 0, failed = 0, dropped = 0, refused = 0;
    double compute_ms = 0, latency = 0;  // sums
    std::string reason, problem;         // the last ones
  };

  std::mutex mutex_;
  Counts now_;
  std::vector<std::string> warnings_;
  uint64_t served_ = 0, dropped_ = 0, refused_ = 0;  // in total
  std::vector<InputWatch::Input> inputs_before_;
  ros::WallTime since_ = ros::WallTime::now();
};

}  // namespace uav_landing
