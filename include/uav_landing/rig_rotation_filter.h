#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/calibration.h"
#include "uav_landing/ground_plane.h"
#include "uav_landing/stage_results.h"

namespace uav_landing {

/// Watch on the rig: the right camera's rotation w against its calibration (rig_rotation.h) as a slow state.
///
/// State: w; the slope s of the runway's direction against the ground plane (p.n = s), which is what a
/// vanishing point p is mostly wrong by and the same in every frame; the error c that lens residuals make in
/// the rx and rz of vertical disparities. Measured by
///   vertical disparities:  (rx, rz) + c    (ry's weak trace there looks like that of a lens: left out)
///   vanishing direction:   h p.g = s + h p.A w,  with g the stereo plane and A its derivative by w.
/// s and h p.A w are told apart by the change of h. Information form, with old measurements forgotten.
/// Successive frames see the same texture and lines: all frames of a second count as one.
///
/// The prior of w is a Student t: a good calibration, seldom a bent rig. Its variance is found by expectation
/// maximisation (Dempster, Laird, Rubin 1977) along the way.
class RigRotationFilter {
 public:
  /// memory: s, after which a measurement counts 1/e.
  RigRotationFilter(const StereoRig& rig, double memory);

  /// Time of the pair that the next measurements are of, s; must not go back.
  void advance(double stamp);
  /// bias_stddev: 1 sigma of w at a good calibration, in pixels at the middle of the image.
  void setPrior(double bias_stddev);
  void updateVertical(const RigRotation& measured);

  /// The plane with w taken out, and, jointly, w with what the vanishing direction says. plane: its
  /// covariance without any error of w. A: planeByRotation(). direction: unit, covariance rad^2; NaN: none.
  /// gate: sigmas, beyond which a direction does not turn the plane and counts less for w. The covariance
  /// returned has w's share, which common() alone tells.
  struct Corrected {
    GroundPlane plane;
    Eigen::Matrix3d common;  ///< share of the plane's covariance that is the same in every frame, 1/m^2
  };
  Corrected correct(const GroundPlane& plane, const Eigen::Matrix3d& A, const Eigen::Vector3d& direction,
                    const Eigen::Matrix3d& direction_covariance, double gate);

  RigRotation rotation() const;
  void reset();

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  void measure(const Eigen::Matrix<double, 1, 6>& row, double value, double variance);
  void solve();
  void learnSlopeVariance(double variance);

  StereoRig rig_;
  double memory_;
  std::optional<double> stamp_;
  double share_ = 0;                 // that a frame's measurements count for
  double calibrated_variance_ = 0;   // of each component of w, rad^2
  double slope_variance_ = 0;        // of s, rad^2; 0: no direction yet
  Vector6 prior_ = Vector6::Zero();  // variances
  Matrix6 information_ = Matrix6::Zero();
  Vector6 right_ = Vector6::Zero();  // information times value
  Vector6 state_ = Vector6::Zero();  // rx, ry, rz, s, c of rx, c of rz. rad
  Matrix6 covariance_ = Matrix6::Zero();
};

}  // namespace uav_landing
