#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// Vanishing point of the runway as a direction, so that none is special when it is far away.
struct VanishingPoint {
  Eigen::Vector3d direction;   ///< unit, camera frame, z > 0
  Eigen::Matrix3d covariance;  ///< rad^2, rank 2 (direction is in its null space)
  std::vector<char> inliers;   ///< per line: 1 when it passes through the point
  int inlier_count = 0;
  /// How many points as well supported are expected of as many lines of random direction; infinite where
  /// that was not asked.
  double coincidences = std::numeric_limits<double>::infinity();
  /// Evidence by which the runway that vanishes here exceeds any other one (RunwayChoice::margin); 0 where no
  /// runway is known to.
  double runway_margin = 0;
};

/// Both views see the same direction: their mean weighted by covariance. The runway's own slope and curve
/// (runway_straightness, rad) is added once, as it is common to both. Either may be missing. Views that
/// disagree enlarge the covariance, and beyond 1 degree (and 5 sigma) nothing is claimed. The inliers of the
/// result are empty: they belong to one view each; inlier_count is that of both.
Expected<VanishingPoint> combineVanishingPoints(const Expected<VanishingPoint>& left,
                                                const Expected<VanishingPoint>& right,
                                                double runway_straightness);

/// The paper's vanishing line: ground normal of a rig that is level but for roll. The vanishing
/// line runs through the vanishing point with the slope of the given roll (0: the paper's assumption). Rank
/// 2: pitch from the vanishing point, roll from roll_stddev.
GroundNormal normalFromVanishingPoint(const VanishingPoint& point, double roll, double roll_stddev);

}  // namespace uav_landing
