#pragma once

#include <Eigen/Core>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Motion of the left camera, in its optical frame now.
struct CameraTwist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Constant(kUnknown);          ///< m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Constant(kUnknown);  ///< rad/s
  Matrix6d covariance = Matrix6d::Constant(kUnknown);                      ///< velocity first
};

/// Mean motion over the step from the previous pair: v = (t/h) h / T, and the reversed turn of the ground in
/// the image. height, height_variance: above the plane that the step's lengths refer to, m, m^2.
/// duration_variance: of the step's duration over its square, due to wrong stamps. NaN when the step has no
/// motion.
CameraTwist cameraTwist(const ApproachAngleResult::Motion& step, double height, double height_variance,
                        double duration_variance);

}  // namespace uav_landing
