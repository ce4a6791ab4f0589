#pragma once

#include <cmath>

#include "height/common_variance.h"
#include "integrity/tests/solution_separation.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Errors of a height in addition to its measurement.
struct HeightErrors {
  /// 1 sigma by which the surface below differs from the plane ahead, as a share of the height.
  double relative = 0;
  double surface = 0;  ///< variance from the visible unevenness of the surface ahead, m^2
  double bend = 0;     ///< variance that the surface's bend leaves open, m^2
  /// Variance from the difference between an average over points and the plane's height, m^2.
  double averaging = 0;
  double rig = 0;  ///< variance from the rig's rotation, m^2; part of the plane's variance
  /// Variance from the runway's width, the same in all pairs, m^2. Part of the measurement's variance.
  double width = 0;
  /// 1 sigma from the length of the baseline, as a share of the height. It is not part of the measurement's
  /// variance, because it is the same for all heights.
  double baseline = 0;

  /// Variance of the difference between the surface below and the plane ahead, m^2.
  double modelVariance(double height) const {
    return std::pow(relative * height, 2) + surface + bend + averaging;
  }
  /// Parts of the variance that the next pairs have as well.
  CommonVariance common(double height) const {
    return {modelVariance(height) - bend + rig, bend, width, baselineVariance(height)};
  }
  double baselineVariance(double height) const { return std::pow(baseline * height, 2); }
};

/// Height from one pair alone.
struct MeasuredHeight {
  Failure failure;  ///< why there is no height
  /// m, m^2; the variance contains the errors of the surface.
  double height = kUnknown, variance = kUnknown;
  HeightErrors errors;
  double points_height = kUnknown;  ///< from eqs (4) and (5), averaged over the points on the plane, m
  bool by_width = false;            ///< whether it comes from the runway's width alone
  /// Height before the one from a known width was fused, m, m^2.
  double stereo_height = kUnknown, stereo_variance = kUnknown;
  /// Height from the runway's width, m, m^2.
  double width_height = kUnknown, width_height_variance = kUnknown;
  /// If the track accepts the height, the runway's width may be learned from it.
  bool teaches_width = false;
  SolutionSeparation::Measurements without;  ///< heights with one source left out

  CommonVariance common() const { return errors.common(height); }
};

}  // namespace uav_landing
