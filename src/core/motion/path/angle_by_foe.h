#pragma once

#include "motion/path/motion_tracker.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Whether the angle is that of the paper, from the focus of expansion as a pixel: of one step.
bool hasPaperForm(const ApproachAngleParameters& parameters);

/// Focus of expansion of the last step, in pixels; in the paper's forms the step's angle by it as well.
struct StepFoe {
  ApproachAngleResult::Motion step;  ///< the motion's, with the angle by the focus where that is asked for
  Eigen::Vector2d foe = Eigen::Vector2d::Constant(kUnknown);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kUnknown);
};
/// motion: of the tracker, which the matches are of. normal: that angles refer to.
StepFoe findStepFoe(const StereoRig& rig, const MotionTracker& tracker, const MotionTracker::Result& motion,
                    const GroundNormal& normal, const ApproachAngleParameters& parameters);

}  // namespace uav_landing
