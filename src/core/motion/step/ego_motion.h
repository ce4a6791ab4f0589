#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/matching/camera_motion.h"
#include "motion/matching/temporal_match.h"
#include "motion/step/row_unknowns.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// What a readout time that is not given does to a motion by the matches, and what these say of it.
struct ReadoutEffect {
  Eigen::Matrix<double, 9, 1> by_time = Eigen::Matrix<double, 9, 1>::Zero();  ///< of R, t and normal, per s
  Eigen::Vector3d own_normal_by_time = Eigen::Vector3d::Zero();               ///< 1/s
  double information = 0;                                                     ///< 1/s^2
  double score = 0;  ///< information times what is missing to the time, 1/s
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
  ReadoutEffect readout;
  /// Share of it that comes from rotations while rows are exposed, see RowShake; 0 where there are none.
  Eigen::Matrix<double, 9, 9> of_shake = Eigen::Matrix<double, 9, 9>::Zero();
  std::vector<char> inliers;
  int inlier_count = 0;
};

/// Robust motion: RANSAC over triples, but where most of the matches are close to the start, then
/// Gauss-Newton with redescending weights over rotation, translation and normal, the latter with its prior
/// covariance (rank 2), and with the rotation prior when there is one. Covariances are less than the matches
/// claim where these agree better (the variance factor a posteriori of least squares), and more where their
/// windows overlap. Fixed
/// seed. Rows that shake (RowShake) are unknowns besides, where the matches show them. Fails when fewer than
/// min_matches agree.
Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const Eigen::Vector3d& normal,
                                        const Eigen::Matrix3d& normal_covariance, const CameraMotion& start,
                                        int min_matches, MotionMemory& memory,
                                        const RotationPrior* rotation = nullptr, const RowDoubt& doubt = {});
/// The same with memory of its own.
Expected<MotionEstimate> estimateMotion(const StereoRig& rig, const std::vector<TemporalMatch>& matches,
                                        const Eigen::Vector3d& normal,
                                        const Eigen::Matrix3d& normal_covariance, const CameraMotion& start,
                                        int min_matches, const RotationPrior* rotation = nullptr);

}  // namespace uav_landing
