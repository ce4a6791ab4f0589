#pragma once

#include <array>
#include <map>
#include <string>

#include "faults/output_score.h"

namespace uav_landing {

/// Counts of one run: before the fault's onset (healthy) and from it on (faulted). Frames of the first
/// second, and frames without a true height, count for neither.
struct FaultScore {
  int healthy = 0, healthy_valid = 0;
  int healthy_uncertain = 0;  ///< no test failed, but the protection level is above the alert limit
  int faulted = 0, faulted_valid = 0;
  int beyond_level = 0;        ///< valid, and the error exceeds the protection level
  int beyond_limit = 0;        ///< valid, and the error exceeds the alert limit
  int misleading = 0;          ///< either of both
  int healthy_misleading = 0;  ///< the same before the onset
  double time_to_alert =
      0;  ///< s, longest time during which the error exceeded the limit and the height was valid
  double worst_level_ratio = 0;  ///< error over protection level, of valid faulted frames
  double worst_limit_ratio = 0;  ///< error over alert limit, of valid faulted frames
  std::string alarm;             ///< reason of the first faulted frame that is not valid
  std::array<OutputScore, kOutputNames.size()> outputs;  ///< in the order of Output

  struct TestCount {
    int made = 0, failed = 0;
  };
  std::map<std::string, TestCount> tests;  ///< by name, on the frames before the onset
  /// "name made failed" of each, separated by semicolons.
  std::string testCounts() const;

  /// Takes one frame. duration: s since the previous frame.
  void take(const LandingResult& landing, const FaultTruth& truth, bool is_faulted, double duration);
  const OutputScore& of(Output output) const { return outputs[static_cast<size_t>(output)]; }

 private:
  void takeHealthy(const LandingResult& landing, bool misleads);

  double misled_for_ = 0;  // s
};

}  // namespace uav_landing
