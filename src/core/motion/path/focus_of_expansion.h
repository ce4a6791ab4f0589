#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/matching/temporal_match.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Focus of expansion as a pixel of the image now.
struct FocusOfExpansion {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d covariance;  ///< pixels^2
};

/// Default form: the image point that the translation t points to. t_covariance: in the square of t's unit.
/// Fails with no_motion when t does not point ahead.
Expected<FocusOfExpansion> foeFromMotion(const StereoRig& rig, const Eigen::Vector3d& t,
                                         const Eigen::Matrix3d& t_covariance);

/// The paper's form (2.3). Every velocity vector is extended to a line over the whole image. The focus is the
/// 3x3 window that most lines cross. One counting image is enough for any number of vectors. R: rotation from
/// then to now that is removed first (identity: exactly as in the paper). The covariance contains the scatter
/// of the lines near the window and the distance of its middle from the point nearest to them. Fails with
/// no_motion when there are no velocities or the lines do not meet.
Expected<FocusOfExpansion> foeSlidingWindow(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                            const Eigen::Matrix3d& R);

}  // namespace uav_landing
