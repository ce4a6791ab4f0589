#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/innovation_scatter.h"
#include "geometry/ground_normal.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Watches the rig: the right camera's rotation w against its calibration (rig_rotation.h) is a slow state.
///
/// The state is w and two errors. The slope s of the runway's direction against the ground plane (p.n = s) is
/// the main error of a vanishing point p, and the same in every frame. The error c in rx and rz of the
/// vertical disparities is what lens residuals cause.
///
/// The measurements are
///   vertical disparities:  (rx, rz) + c    (without ry: its weak trace there looks like that of a lens)
///   vanishing direction:   h p.g = s + h p.A w,  with g the stereo plane and A its derivative by w.
/// The change of h tells s and h p.A w apart.
///
/// An attitude sensor's normal measures in the same way, with its two directions in the ground
/// (levelDirections()). Each has a slope of its own: the ground's slope, and the slow error of the sensor. So
/// does the normal that fits the motion in the left image (MotionEstimate::own_normal). Its slow errors are
/// small.
///
/// The filter is in information form and forgets old measurements. Successive frames see the same texture and
/// lines, so all frames of a second count as one.
///
/// The prior of w is a Student t: most rigs are as calibrated, and few are bent. Its variance is found along
/// the way by expectation maximisation (Dempster, Laird, Rubin 1977).
class RigRotationFilter {
 public:
  /// memory: s, after which the weight of a measurement has fallen to 1/e.
  RigRotationFilter(const StereoRig& rig, double memory);

  /// Sets the time of the pair that the next measurements belong to. stamp: s, must not go back.
  void advance(double stamp);
  /// bias_stddev: 1 sigma of w after a good calibration, in pixels at the middle of the image.
  /// row_bias_stddev: 1 sigma of the rows' errors there by the lenses, pixels.
  void setPrior(double bias_stddev, double row_bias_stddev);
  void updateVertical(const RigRotation& measured);

  /// Other sources for the ground's normal besides the stereo plane, as far as they are known.
  struct Others {
    std::optional<GroundDirection> vanishing;
    /// The normal of level ground by an attitude sensor. Its covariance contains the ground's slope.
    std::optional<GroundNormal> level;
    std::optional<GroundNormal> moving;  ///< the normal that fits the motion in the image
  };
  /// The result of correct().
  struct Corrected {
    GroundPlane plane;
    Eigen::Matrix3d common;  ///< share of the plane's covariance that is the same in every frame, 1/m^2
    Eigen::Matrix3d kept;    ///< turns errors of the given plane into those of the corrected one
  };
  /// Returns the plane without the effect of w, and uses the other directions for the plane and for w
  /// together. plane: its covariance must not contain errors of w. A: planeByRotation(). gate: in sigmas; a
  /// direction beyond it does not turn the plane and counts less for w. The returned covariance contains the
  /// errors of the state.
  Corrected correct(const GroundPlane& plane, const Eigen::Matrix3d& A, const Others& others, double gate);
  /// Decides about the pair that was given to correct() last. believed: its measurements of w are learned,
  /// else they are forgotten.
  void settle(bool believed);

  RigRotation rotation() const;
  void reset();
  /// Forgets what was known of w, because something has turned the camera. vertical: as for updateVertical(),
  /// mean of a second.
  void startAnew(const RigRotation& vertical);

 private:
  static constexpr int kSize = 10;
  // Indices of the first slopes in the state.
  static constexpr int kVanishing = 3, kLevel = 6, kMoving = 8;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  /// A direction that lies in the ground plane except for a slope, which is a state of its own.
  struct Sloping {
    GroundDirection ground;
    int slope;  // index of the state
    bool isMoving() const { return slope >= kMoving; }
  };
  /// Errors of a plane: by_state times the errors of the state, plus noise of this frame.
  struct Joint {
    GroundPlane plane;  // covariance: of the noise alone
    Eigen::Matrix<double, 3, kSize> by_state;
    Eigen::Matrix3d kept;     // turns errors of the plane before into those of this one
    Eigen::Matrix3d lasting;  // share of the noise that the next frames have, too
  };
  /// Equations for the state from the directions of one pair. They share the noise of the plane, so all are
  /// solved at once.
  struct Equations {
    Eigen::MatrixXd rows{0, kSize}, tips{0, 3};
    // inflations: factors of the stddev, for what next frames repeat and beyond the gate.
    Eigen::VectorXd values, noises, inflations;
    Eigen::Matrix3d plane_covariance = Eigen::Matrix3d::Zero();

    void add(const Eigen::RowVector3d& tip, const GroundPlane& plane, const Eigen::Matrix3d& A, int slope,
             double noise, double inflation);
  };
  static std::vector<Sloping> directionsOf(const Others& others);
  struct Innovation {
    double value, variance;
    Eigen::Vector3d gain;  // by which the innovation changes the plane
  };
  Innovation innovationOf(const Sloping& sloping, double noise, const Joint& joint) const;
  void fuse(const Sloping& sloping, double noise, const Innovation& innovation, Joint& joint) const;
  double noiseOf(const Sloping& sloping, double variance, const Joint& joint);
  void solve();
  double learnSlopeVariance(int slope, double variance);

  StereoRig rig_;
  double memory_;
  InnovationScatter moving_scatter_;
  std::optional<double> stamp_;
  double share_ = 0;                        // weight of one frame's measurements, at most 1
  double calibrated_variance_ = 0;          // of each component of w, rad^2
  double row_bias_stddev_ = 0;              // pixels
  Vector slope_variance_ = Vector::Zero();  // of each s, rad^2; 0: no direction seen yet
  Vector prior_ = Vector::Ones();           // variances
  Matrix information_ = Matrix::Zero();
  Vector right_ = Vector::Zero();  // information times value
  // Order: rx, ry, rz, s, c of rx, c of rz, s of level forward and left, s of moving forward and left; rad.
  Vector state_ = Vector::Zero();
  Matrix covariance_ = Matrix::Zero();
  Equations of_last_pair_;
};

}  // namespace uav_landing
