#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "geometry/ground_normal.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// Vanishing point of the runway as a direction, so that a point far away needs no special case.
struct VanishingPoint {
  Eigen::Vector3d direction;   ///< unit, camera frame, z > 0
  Eigen::Matrix3d covariance;  ///< rad^2, rank 2 (direction is in its null space)
  std::vector<char> inliers;   ///< per line: 1 when it passes through the point
  int inlier_count = 0;
  /// Expected number of equally well supported points among as many lines of random direction; infinite when
  /// it was not computed.
  double coincidences = std::numeric_limits<double>::infinity();
  /// Evidence by which the runway that vanishes here exceeds any other one (RunwayChoice::margin); 0 when no
  /// runway is known to vanish here.
  double runway_margin = 0;
};

/// Mean of both views, weighted by covariance, as they see the same direction. The runway's own slope and
/// curve (runway_straightness, rad) are common to both, so they are added once. Either view may be missing.
/// Views that disagree enlarge the covariance. Beyond 1 degree (and 5 sigma) it fails. The inliers of the
/// result are empty, as they belong to one view each; inlier_count is that of both.
Expected<VanishingPoint> combineVanishingPoints(const Expected<VanishingPoint>& left,
                                                const Expected<VanishingPoint>& right,
                                                double runway_straightness);

/// The paper's vanishing line: ground normal of a rig that is level except for roll. The vanishing line runs
/// through the vanishing point with the slope of the given roll, rad (0: the paper's assumption). The
/// covariance has rank 2: pitch from the vanishing point, roll from roll_stddev (rad). None when it is not
/// finite.
std::optional<GroundNormal> normalFromVanishingPoint(const VanishingPoint& point, double roll,
                                                     double roll_stddev);

}  // namespace uav_landing
