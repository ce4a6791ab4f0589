#pragma once

#include <map>
#include <string>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Truth of one frame; NaN when unknown. m, rad.
struct FaultTruth {
  double height = kUnknown, angle = kUnknown, yaw = kUnknown;
};

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
  int faulted_angle_valid = 0;
  int angle_misleading = 0;          ///< valid, and the error exceeds angleBound()
  int healthy_angle_misleading = 0;  ///< the same before the onset
  double worst_angle_ratio = 0;      ///< error over angleBound(), of valid faulted angles
  int healthy_yaw_known = 0, faulted_yaw_known = 0;
  int yaw_misleading = 0;          ///< known, and the error exceeds yawBound()
  int healthy_yaw_misleading = 0;  ///< the same before the onset
  double worst_yaw_ratio = 0;      ///< error over yawBound(), of known faulted yaws

  struct TestCount {
    int made = 0, failed = 0;
  };
  std::map<std::string, TestCount> tests;  ///< by name, on the frames before the onset
  /// "name made failed" of each, separated by semicolons.
  std::string testCounts() const;

  /// Takes one frame. duration: s since the previous frame.
  void take(const LandingResult& landing, const FaultTruth& truth, bool is_faulted, double duration);
  /// Error beyond which a valid approach angle misleads, rad. variance: the claimed one.
  static double angleBound(double variance);
  /// Error beyond which a known yaw misleads, rad. variance: the claimed one.
  static double yawBound(double variance);

 private:
  void takeHealthy(const LandingResult& landing, bool misleads);
  void takeAngle(const LandingResult& landing, double true_angle, bool is_faulted);
  void takeYaw(const LandingResult& landing, double true_yaw, bool is_faulted);

  double misled_for_ = 0;  // s
};

}  // namespace uav_landing
