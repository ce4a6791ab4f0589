#include "motion/path/angle_by_foe.h"

#include <cmath>

#include "motion/path/approach_angle.h"
#include "motion/path/focus_of_expansion.h"

namespace uav_landing {
namespace {

/// Approach angle of the step from the focus as a pixel, as in the paper.
void takeAngle(const StereoRig& rig, const GroundNormal& normal, AngleFormula formula, StepFoe& found) {
  const Eigen::Vector3d direction = rig.ray(found.foe.x(), found.foe.y());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  const Eigen::DiagonalMatrix<double, 2> per_pixel(1 / rig.fx, 1 / rig.fy);
  covariance.topLeftCorner<2, 2>() = per_pixel * found.covariance * per_pixel;
  const Eigen::Vector3d& n = normal.vector();
  found.step.angle = formula == AngleFormula::kEq1
                         ? approachAngleEq1(rig.fy * n.z() / n.y(), rig.cy - found.foe.y(), rig.fy)
                         : approachAngle(n, direction);
  found.step.angle_variance = approachAngleVariance(n, normal.covariance(), direction, covariance);
}

/// Adds an error that the scatter of the velocities does not show. A rotation left in the velocities moves
/// all of their crossings, and eq (1) ignores roll and drift. The difference between the paper's form and the
/// motion is a measure of it.
void claimDifference(const StereoRig& rig, const MotionTracker::Result& motion, StepFoe& found) {
  const Eigen::Vector2d off = found.foe - rig.project(motion.step_estimate->motion.t);
  found.covariance += off * off.transpose();
  found.step.angle_variance += std::pow(found.step.angle - motion.step.angle, 2);
}

}  // namespace

bool hasPaperForm(const ApproachAngleParameters& parameters) {
  return parameters.foe_method == FoeMethod::kSlidingWindow || parameters.angle_formula == AngleFormula::kEq1;
}

StepFoe findStepFoe(const StereoRig& rig, const MotionTracker& tracker, const MotionTracker::Result& motion,
                    const GroundNormal& normal, const ApproachAngleParameters& parameters) {
  StepFoe found;
  found.step = motion.step;
  if (motion.step.failure || !motion.step_estimate) return found;
  const MotionEstimate& estimate = *motion.step_estimate;
  const bool vote = parameters.foe_method == FoeMethod::kSlidingWindow;
  const Eigen::Matrix3d rotation =
      parameters.remove_rotation ? estimate.motion.R : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Expected<FocusOfExpansion> foe =
      vote ? foeSlidingWindow(rig, tracker.stepMatches(), rotation)
           : foeFromMotion(rig, estimate.motion.t, estimate.covariance.block<3, 3>(3, 3));
  if (!foe) {
    if (!vote) return found;
    found.step.failure = foe.error();
    found.step.angle = found.step.angle_variance = kUnknown;
    return found;
  }
  found.foe = foe->pixel;
  found.covariance = foe->covariance;
  if (!hasPaperForm(parameters)) return found;
  takeAngle(rig, normal, parameters.angle_formula, found);
  claimDifference(rig, motion, found);
  return found;
}

}  // namespace uav_landing
