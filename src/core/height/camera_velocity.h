#pragma once

#include <Eigen/Core>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// A velocity of the left camera in its optical frame now, m/s, and its covariance, m^2/s^2.
struct CameraVelocity {
  Eigen::Vector3d mean = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kUnknown);
};

/// Mean velocity of the step from the previous frame, v = (t/h) h / T. height, height_variance: above the
/// plane that the step's lengths are measured in, m, m^2. duration_variance: relative, of the step's duration
/// by wrong stamps. What is common to all of them, the height and the duration, is along v. NaN when the step
/// has no motion.
CameraVelocity cameraVelocity(const ApproachAngleResult::Motion& step, double height, double height_variance,
                    double duration_variance);

}  // namespace uav_landing
