#pragma once

#include <optional>

#include "far/sight_fit.h"
#include "rig/rig_rotation_filter.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// The ground as Sighting has to know it, from pair to pair: free of what a turned right camera does to it.
///
/// A yaw of the right camera is an error that all disparities have in common. Near the ground it hardly
/// matters. From afar it is a good part of the runway's disparity. It tilts the ground's plane by stereo, and
/// leaves alone the normal that the motion in the left image asks for. So the rig's watch tells it.
class SightedGround {
 public:
  explicit SightedGround(const StereoRig& rig);

  /// The ground of a pair, by what the pairs before have told of the rig. has_plane: stereo's plane may be
  /// used. imu: gives the normal otherwise.
  KnownGround of(const StereoDepthResult& stereo, bool has_plane, const AttitudePrior& imu);
  /// Learns from the pair that was asked for last. motion: of this pair; its normal is used.
  void learn(const ApproachAngleResult::Motion& motion);
  void reset();

 private:
  /// The plane of a pair, without the rig's share of its covariance, and how the rig's rotation moves it.
  struct Seen {
    GroundPlane plane;
    Eigen::Matrix3d by_rotation;
  };
  StereoRig rig_;
  RigRotationFilter rotation_;
  std::optional<double> last_stamp_;
  std::optional<Seen> seen_;
};

}  // namespace uav_landing
