#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The vanishing direction of the runway, carried along the camera's rotation: it is the same direction on
/// every pair, so that one which leaps is of other lines, and no witness against the plane. That a plane
/// which leaps is wrong shows against a direction that does not.
class VanishingMemory {
 public:
  struct Direction {
    Eigen::Vector3d direction;   ///< unit, camera frame
    Eigen::Matrix3d covariance;  ///< rad^2
  };
  /// A pair. seen: not finite where none is in view. axis: unit, only what is along it counts: the ground's
  /// normal, as it is what a plane is contradicted by, or across for the yaw. turn: since the pair before;
  /// without its rotation, or where it is over another time, the camera may have turned by up to 5 degrees
  /// per second. True when the direction leaps: by more than five of its sigmas from the ones before, of
  /// which three have agreed, the last one within a second.
  bool leaps(double stamp, const Direction& seen, const Eigen::Vector3d& axis,
             const ApproachAngleResult::Motion& turn);
  /// The one of the pairs before, where the camera looks now.
  const std::optional<Direction>& remembered() const { return last_; }
  /// Pairs in a row that have agreed with the one before.
  int agreements() const { return agreements_; }

 private:
  void carry(double stamp, const ApproachAngleResult::Motion& turn);

  std::optional<Direction> last_;
  double stamp_ = 0, agreed_ = 0;  // s
  int agreements_ = 0;             // in a row
};

}  // namespace uav_landing
