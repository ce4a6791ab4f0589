#pragma once

#include <array>

#include "results/protection_factors.h"
#include "runway/position/position_axis.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Protection level of the position across the runway by solution separation (solution_separation.h). Beside
/// the position with all sources there is one without each source of the centre line. If that source is
/// wrong, the position without it is right. The height makes metres of heights, so its protection level
/// counts in proportion.
class PositionSeparation {
 public:
  explicit PositionSeparation(const KalmanHeightParameters& parameters);

  struct Height {
    double value, variance, protection_level;  ///< m, m^2, m
  };

  // These are called together with the same functions of the position's axis.
  void predict(double movement, double stddev);
  /// seen: in heights. Where a source cannot be left out, nothing is measured without it.
  void update(const CentreSolutions& seen, const Height& height, double seconds);
  void forgetAbove(double stddev);

  /// Whether a position without one of the sources contradicts y. matters: difference that may remain, m.
  bool contradicts(double y, double matters) const;

  /// Of the position y with this variance, m, m^2. Not known while nothing tells the position without one of
  /// the sources.
  double protectionLevel(double y, double variance) const;

 private:
  ProtectionFactors factors_;
  std::array<PositionAxis, kCentreSources> without_;
  double height_share_ = kUnknown;  // protection level of the last height over that height
};

}  // namespace uav_landing
