#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

// Motion is scale-free here: lengths are in units of the height now, so that the ground plane is the unit
// normal n (n.X = 1 on it) and t is t / h.

/// Camera motion from a frame then to the frame now: x_now = R x_then - t, t in the frame now.
struct CameraMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Where the point on the ray r (third component 1) at inverse depth w was seen then, up to scale.
  Eigen::Vector3d seenThen(const Eigen::Vector3d& r, double w) const { return R.transpose() * (r + w * t); }
};

/// A corner now and where it was then. Pixels of the rectified left image.
struct TemporalMatch {
  Eigen::Vector2d now, then;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of then given now, pixels^2
  /// How then follows from the warp it was looked for with, and that warp (PatchRefinement::Claim).
  std::array<Eigen::Matrix2d, 2> by_warp = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  bool on_plane = true;      ///< depth from the ground plane, else from its own disparity
  double inverse_depth = 0;  ///< of a point off the plane, times height
  double inverse_depth_stddev = 0;
  /// Side of the square of pixels that it was matched by; those that overlap share noise.
  double extent = 0;
};

/// Motion with the ground normal that fits both the prior and the matches.
struct MotionEstimate {
  CameraMotion motion;
  Eigen::Vector3d normal;
  /// Of (rotation vector of R, in the frame now; t; normal). The normal's scale is fixed.
  Eigen::Matrix<double, 9, 9> covariance;
  /// Share of it that comes from the error of the normal that was given.
  Eigen::Matrix<double, 9, 9> of_normal;
  /// The ground's normal by the matches (and the rotation known beforehand) alone, and its covariance (rank
  /// 2, rad^2), independent of the one that was given but for where it is linearised, and of stereo but for
  /// the depth of points off the plane; not finite where the matches do not tell it. Unlike the motion's,
  /// its covariance is larger where parts of the image are wrong together.
  Eigen::Vector3d own_normal = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d own_normal_covariance = Eigen::Matrix3d::Constant(kUnknown);
  std::vector<char> inliers;
  int inlier_count = 0;
};

/// Rotation from then to now that is known beforehand, of an inertial sensor.
struct RotationPrior {
  Eigen::Matrix3d R;
  Eigen::Matrix3d covariance;  ///< of its rotation vector, in the frame now, rad^2
};

/// Robust motion: RANSAC over triples, but where most of the matches are close to the start, then
/// Gauss-Newton with redescending weights over rotation, translation and normal, the latter with its prior
/// covariance (rank 2), and with the rotation prior when there is one. Covariances are less than the matches
/// claim where these agree better (the variance factor a posteriori of least squares), and more where their
/// windows overlap. Fixed seed. Fails when fewer than min_matches agree.
Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const Eigen::Vector3d& normal,
                                        const Eigen::Matrix3d& normal_covariance, const CameraMotion& start,
                                        int min_matches, const RotationPrior* rotation = nullptr);

}  // namespace uav_landing
