#pragma once

#include <cmath>

#include "height/common_variance.h"
#include "integrity/solution_separation.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What a height is wrong by besides its measurement.
struct HeightErrors {
  double relative = 0;   ///< 1 sigma by which the surface below differs from the plane ahead, of the height
  double surface = 0;    ///< variance by the unevenness that shows ahead, m^2
  double bend = 0;       ///< by what the bend of the surface leaves open, m^2
  double averaging = 0;  ///< by what makes an average over points another height than the plane's, m^2
  double rig = 0;        ///< by the rig's rotation, m^2; part of the plane's variance
  double width = 0;      ///< by the runway's width, the same on all pairs, m^2; part of the measurement's
  /// 1 sigma by the baseline's length, of the height. No part of the measurement's variance: all heights are
  /// wrong by it alike.
  double baseline = 0;

  /// By how much the surface below may differ from the plane seen ahead, m^2.
  double modelVariance(double height) const {
    return std::pow(relative * height, 2) + surface + bend + averaging;
  }
  /// Of a height's variance what the next pairs have as well.
  CommonVariance common(double height) const {
    return {modelVariance(height) - bend + rig, bend, width, baselineVariance(height)};
  }
  double baselineVariance(double height) const { return std::pow(baseline * height, 2); }
};

/// A height by one pair alone.
struct MeasuredHeight {
  Failure failure;                                ///< why there is none
  double height = kUnknown, variance = kUnknown;  ///< m, m^2, what the surface is wrong by included
  HeightErrors errors;
  double points_height = kUnknown;  ///< eqs (4), (5) averaged over the points on the plane, m
  bool by_width = false;            ///< from the runway's width alone
  /// Before a known width is fused, m, m^2.
  double stereo_height = kUnknown, stereo_variance = kUnknown;
  /// From the runway's width, m, m^2.
  double width_height = kUnknown, width_height_variance = kUnknown;
  bool teaches_width = false;  ///< the runway's width may be learned from it, when it is accepted
  SolutionSeparation::Measurements without;  ///< with each source left out

  CommonVariance common() const { return errors.common(height); }
};

}  // namespace uav_landing
