#pragma once

#include <optional>

#include "geometry/ground_normal.h"
#include "results/camera_step.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// One pair as the parts of the landing estimate need it: the checked results of both earlier stages.
struct PairInput {
  /// fuse_imu: use the rotation of the inertial sensor when the images give none. readout_given: whether the
  /// parameters give a readout time; else that of the result counts, or a global shutter.
  PairInput(const StereoRig& rig, const StereoDepthResult& stereo, const ApproachAngleResult& approach,
            bool fuse_imu, bool readout_given);

  StereoDepthResult stereo;
  ApproachAngleResult approach;
  double T = 0;  ///< s since the previous pair; 0 when that pair says nothing about this one
  /// Rotation of the camera since the previous pair.
  ApproachAngleResult::Motion turn;

  double stamp() const { return stereo.stamp; }
  /// Whether the left image is the same as in the previous pair, so that nothing new was seen.
  bool repeated() const { return stereo.left_repeated; }
  const ApproachAngleResult::Motion& step() const { return approach.step; }
  /// Motion that the approach angle belongs to: the one over the sliding window, or the step when that has
  /// none.
  const ApproachAngleResult::Motion& path() const;
  /// Ground normal that the angles are measured against.
  std::optional<GroundNormal> normal() const { return GroundNormal::of(approach.n, approach.n_covariance); }
  /// Ground normal from the motion in the image over the same time as path().
  std::optional<GroundNormal> normalByMotion() const;
};

/// Distance that the camera moved in a step. height: above the plane that the step's lengths refer to, m.
/// Nothing when the step has no motion. A step that is too uncertain for an angle still has a distance, for
/// example while the image stands still.
std::optional<CameraStep> cameraStep(const ApproachAngleResult::Motion& step, double height);

/// Uncertainty of a step beyond its own claims.
struct MotionDoubt {
  double angle_variance = 0;     ///< from other possible normals of the ground, rad^2
  double duration_variance = 0;  ///< of durations between stamps, divided by their squares
};

}  // namespace uav_landing
