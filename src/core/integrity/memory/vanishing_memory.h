#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The vanishing direction of the runway, carried along with the camera's rotation. It is the same direction
/// on every pair. A direction that jumps belongs to other lines, and is no witness against the plane. If the
/// plane jumps, a direction that does not jump shows that the plane is wrong.
class VanishingMemory {
 public:
  struct Direction {
    Eigen::Vector3d direction;   ///< unit, camera frame
    Eigen::Matrix3d covariance;  ///< rad^2
  };
  /// Follows a pair. stamp: s. seen: not finite when no runway is in view. turn: since the pair before. If
  /// turn has no rotation, or belongs to another time, the camera may have turned by up to 5 degrees per
  /// second.
  ///
  /// axis: unit vector; only the part of the direction along it counts. For a contradiction of the plane it
  /// is the ground's normal, for the yaw it is the direction across.
  ///
  /// True when the direction jumps by more than five sigmas from those before. At least three of these must
  /// have agreed, the last one within a second.
  bool leaps(double stamp, const Direction& seen, const Eigen::Vector3d& axis,
             const ApproachAngleResult::Motion& turn);
  /// Direction of the pairs before, in the camera's frame now.
  const std::optional<Direction>& remembered() const { return last_; }
  /// Number of pairs in a row that agreed with the one before.
  int agreements() const { return agreements_; }

 private:
  void carry(double stamp, const ApproachAngleResult::Motion& turn);

  std::optional<Direction> last_;
  double stamp_ = 0, agreed_ = 0;  // s
  int agreements_ = 0;             // pairs in a row
};

}  // namespace uav_landing
