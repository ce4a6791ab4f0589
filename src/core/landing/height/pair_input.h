#pragma once

#include <optional>

#include "results/camera_step.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// One pair as the parts of the landing estimate see it: what both stages before said of it, checked.
struct PairInput {
  /// fuse_imu: where the images do not tell how the camera turned, an inertial sensor does.
  PairInput(const StereoRig& rig, const StereoDepthResult& stereo, const ApproachAngleResult& approach,
            bool fuse_imu);

  StereoDepthResult stereo;
  ApproachAngleResult approach;
  double T = 0;  ///< s since the pair before; 0 where that says nothing
  /// How the camera turned since the pair before.
  ApproachAngleResult::Motion turn;

  double stamp() const { return stereo.stamp; }
  /// The left image is the very one of the pair before: nothing has been seen since.
  bool repeated() const { return stereo.left_repeated; }
  const ApproachAngleResult::Motion& step() const { return approach.step; }
  /// The motion that the approach angle is of: over the window, or the step alone where that has none.
  const ApproachAngleResult::Motion& path() const;
  /// The ground's normal that its angles are measured against.
  GroundNormal normal() const { return {approach.n, approach.n_covariance}; }
  /// The ground's normal by what moves in the image over the same time.
  GroundNormal normalByMotion() const;
};

/// The way of a step. height: above the plane that its lengths are measured in, m. None where it has none:
/// whether it is certain enough for an angle does not matter, as that of a picture that stands still is not.
std::optional<CameraStep> cameraStep(const ApproachAngleResult::Motion& step, double height);

/// What a step is less certain by than it claims.
struct MotionDoubt {
  double angle_variance = 0;     ///< by other normals of the ground, rad^2
  double duration_variance = 0;  ///< of durations between stamps, over their squares
};

}  // namespace uav_landing
