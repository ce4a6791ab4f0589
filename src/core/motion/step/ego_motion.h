#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/ground_normal.h"
#include "motion/matching/camera_motion.h"
#include "motion/matching/temporal_match.h"
#include "motion/step/row_unknowns.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Effect of an unknown readout time on a motion (derivatives by that time), and what the matches say about
/// the time.
struct ReadoutEffect {
  Eigen::Matrix<double, 9, 1> by_time = Eigen::Matrix<double, 9, 1>::Zero();  ///< of (R, t, normal), 1/s
  Eigen::Vector3d own_normal_by_time = Eigen::Vector3d::Zero();               ///< of own_normal, 1/s
  double information = 0;                                                     ///< on the readout time, 1/s^2
  double score = 0;  ///< information times (true time - time in use), 1/s
};

/// Motion and ground normal that fit the prior and the matches together.
struct MotionEstimate {
  CameraMotion motion;
  Eigen::Vector3d normal;
  /// Covariance of the rotation vector of R (in the frame now), t and the normal, in this order. The normal
  /// keeps its length.
  Eigen::Matrix<double, 9, 9> covariance;
  /// Part of the covariance that comes from the error of the given normal.
  Eigen::Matrix<double, 9, 9> of_normal;
  /// Ground normal from the matches alone, and from the rotation prior when there is one. Its covariance has
  /// rank 2, rad^2. It depends on the given normal only through the point of linearisation, and on stereo
  /// only through the depth of points off the plane. Not finite when the matches do not determine it. Unlike
  /// that of the motion, its covariance grows when the matches of one part of the image are wrong together.
  Eigen::Vector3d own_normal = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d own_normal_covariance = Eigen::Matrix3d::Constant(kUnknown);
  ReadoutEffect readout;
  /// Part of the covariance that comes from rotations while rows are exposed (see RowShake); 0 without them.
  Eigen::Matrix<double, 9, 9> of_shake = Eigen::Matrix<double, 9, 9>::Zero();
  Vibration vibration;  ///< that the matches show
  DelayEffect delay;
  std::vector<char> inliers;
  int inlier_count = 0;
};

/// What is known about a motion before its matches.
struct MotionPrior {
  CameraMotion start;                       ///< where the search begins; it has no weight of its own
  GroundNormal normal;                      ///< of the ground now
  const RotationPrior* rotation = nullptr;  ///< null: not known
  RowDoubt rows = {};                       ///< what rows that are exposed one after the other may do
};

/// Robust estimate of the motion from the ground normal and the matches.
///
/// RANSAC over triples of matches finds a start. It is skipped when most of the matches are close to the
/// given one. Gauss-Newton with redescending weights then solves for rotation, translation and normal. The
/// given normal enters as a prior with its covariance (rank 2, rad^2), and so does the rotation prior when
/// there is one.
///
/// Matches that agree better than they claim reduce the covariances (variance factor a posteriori). Windows
/// that overlap enlarge them. Where the matches show that rows shake (RowShake), the shake is an additional
/// unknown. Deterministic: the random numbers have a fixed seed.
///
/// Fails with too_few_matches when there are fewer than min_matches (or four), and with motion_inconsistent
/// when fewer than min_matches agree or they do not determine the motion.
Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const MotionPrior& prior, int min_matches, MotionMemory& memory);
/// The same, with working memory of its own.
Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const MotionPrior& prior, int min_matches);

}  // namespace uav_landing
