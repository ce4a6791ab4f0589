#pragma once

#include "geometry/ground_normal.h"
#include "motion/path/motion_tracker.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// Whether the parameters ask for one of the paper's forms. They take the angle of one step from the focus of
/// expansion as a pixel.
bool hasPaperForm(const ApproachAngleParameters& parameters);

/// Focus of expansion of the last step, in pixels. In the paper's forms, also the step's angle that follows
/// from it.
struct StepFoe {
  /// As in the motion, but in the paper's forms the angle follows from the focus.
  ApproachAngleResult::Motion step;
  Eigen::Vector2d foe = Eigen::Vector2d::Constant(kUnknown);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kUnknown);
};
/// tracker: its stepMatches() belong to this motion. motion: result of the tracker. normal: the ground normal
/// that angles refer to. The focus stays unknown (kUnknown) when it cannot be found. In the form with the
/// sliding window, step.failure then says why.
StepFoe findStepFoe(const StereoRig& rig, const MotionTracker& tracker, const MotionTracker::Result& motion,
                    const GroundNormal& normal, const ApproachAngleParameters& parameters);

}  // namespace uav_landing
