#pragma once

#include <array>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Truth of one frame; NaN when unknown. m, rad, m/s.
struct FaultTruth {
  double height = kUnknown, angle = kUnknown, yaw = kUnknown;
  double x = kUnknown, y = kUnknown, height_above_runway = kUnknown;
  double speed = kUnknown;
  Eigen::Vector3d velocity = Eigen::Vector3d::Constant(kUnknown);  ///< in the left camera's frame
  double runway_width = kUnknown;
};

/// Outputs besides the height, in the order of FaultScore::outputs.
enum class Output { kAngle, kYaw, kX, kY, kVelocity, kHeightAboveRunway };
constexpr std::array<const char*, 6> kOutputNames = {"angle", "yaw", "x", "y", "velocity", "runway_height"};

/// An output of one frame against the truth.
struct OutputError {
  bool known = false;       ///< it may be used
  double ratio = kUnknown;  ///< error over the error beyond which it misleads; NaN where the truth is unknown
  /// A known output without a number misleads, too.
  bool misleads() const { return known && !(ratio <= 1); }
};

/// Each output in the order of Output, or with known == false where its truth is not known.
std::array<OutputError, kOutputNames.size()> outputErrors(const LandingResult& landing,
                                                          const FaultTruth& truth);

/// How one output did in a run: before the fault's onset (healthy) and from it on (faulted).
struct OutputScore {
  int healthy_known = 0, healthy_misleading = 0;
  int faulted_known = 0, misleading = 0;
  double worst_ratio = 0;    ///< of known faulted ones
  double time_to_alert = 0;  ///< s, longest time for which it misled

  /// duration: s since the previous frame.
  void take(const OutputError& error, bool is_faulted, double duration);

 private:
  double misled_for_ = 0;  // s
};

}  // namespace uav_landing
