#pragma once

#include <cstdint>

#include "uav_landing/parameters.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// 1 sigma of what the estimator is told to expect of its calibration.
struct CalibrationPrior {
  double baseline = 0;            ///< share of the baseline
  double rx = 0, ry = 0, rz = 0;  ///< rotation of the right camera in rectified axes, rad
};
CalibrationPrior calibrationPrior(const Parameters& parameters, double focal_length);

/// A random full-scale flight: runway, marks, light, both sensors, path, attitude and wobble are drawn, and
/// the calibration's errors from what the estimator is told of them. The seed decides everything. A snippet
/// is a short piece of a glide that ends near this height, m; as many frames as asked for, at 20 Hz.
SimulatorParameters drawSnippet(uint64_t seed, double height, int frames, const Parameters& parameters);
/// An approach from 60 m down to the flare, with gusts on some.
SimulatorParameters drawApproach(uint64_t seed, const Parameters& parameters);

}  // namespace uav_landing
