#pragma once

#include <optional>

#include "motion/path/path_angle_filter.h"
#include "motion/step/ego_motion.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Adds the error of an estimated readout time to the covariances.
void claimReadout(const ReadoutEstimate& readout, MotionEstimate& estimate);

/// What is known of a motion besides its estimate.
struct MotionFacts {
  double duration = 0;  ///< s
  size_t matches = 0;
  ReadoutEstimate readout;
  bool may_roll = false;  ///< whether rows have times, or may have
  bool rolling = false;   ///< whether they are taken to have
  /// Least translation, in its standard deviations, for an angle.
  double min_motion = 0;
};

/// A motion as it is published, and its approach angle as a measurement for the filter, if there is one.
struct MotionDescription {
  ApproachAngleResult::Motion motion;
  std::optional<PathAngleFilter::Measurement> angle;
};

MotionDescription describe(const Expected<MotionEstimate>& estimate, const MotionFacts& facts);

}  // namespace uav_landing
