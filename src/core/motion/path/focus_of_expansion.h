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

/// Default: where the translation of the motion points. Fails with no_motion when it does not point ahead.
Expected<FocusOfExpansion> foeFromMotion(const StereoRig& rig, const Eigen::Vector3d& t,
                                         const Eigen::Matrix3d& t_covariance);

/// The paper's form (2.3): every velocity vector is extended over the whole image, and the 3x3 window that
/// most lines cross is the focus. Only one counting image, whatever the number of vectors. R: rotation from
/// then to now to take out first (identity: the paper to the letter). Covariance: from the lines through the
/// window, and how far its middle is from the point nearest to them.
Expected<FocusOfExpansion> foeSlidingWindow(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                            const Eigen::Matrix3d& R);

}  // namespace uav_landing
