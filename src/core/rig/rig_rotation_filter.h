#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/innovation_scatter.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Watch on the rig: the right camera's rotation w against its calibration (rig_rotation.h) as a slow state.
///
/// State: w; the slope s of the runway's direction against the ground plane (p.n = s), which is what a
/// vanishing point p is mostly wrong by and the same in every frame; the error c that lens residuals make in
/// the rx and rz of vertical disparities. Measured by
///   vertical disparities:  (rx, rz) + c    (ry's weak trace there looks like that of a lens: left out)
///   vanishing direction:   h p.g = s + h p.A w,  with g the stereo plane and A its derivative by w.
/// s and h p.A w are told apart by the change of h. An attitude sensor's normal measures in the same way by
/// its two directions in the ground (levelDirections()), each with a slope of its own: that of the ground,
/// and the sensor's slow error. So does the normal that the motion in the left image asks for
/// (MotionEstimate::own_normal), whose slow errors are small. Information form, with old measurements
/// forgotten. Successive frames see the same texture and lines: all frames of a second count as one.
///
/// The prior of w is a Student t: a good calibration, seldom a bent rig. Its variance is found by expectation
/// maximisation (Dempster, Laird, Rubin 1977) along the way.
class RigRotationFilter {
 public:
  /// memory: s, after which a measurement counts 1/e.
  RigRotationFilter(const StereoRig& rig, double memory);

  /// Time of the pair that the next measurements are of, s; must not go back.
  void advance(double stamp);
  /// bias_stddev: 1 sigma of w at a good calibration, in pixels at the middle of the image. row_bias_stddev:
  /// 1 sigma of what its lenses do to rows there, pixels.
  void setPrior(double bias_stddev, double row_bias_stddev);
  void updateVertical(const RigRotation& measured);

  /// What is known of the ground besides the stereo plane, each NaN where it is not.
  struct Others {
    GroundDirection vanishing;
    /// Of level ground, by an attitude sensor; with the ground's slope in its covariance.
    GroundNormal level;
    GroundNormal moving;  ///< by what moves in the image
  };
  /// The plane with w taken out, and, jointly, w with what the others say. plane: its covariance without any
  /// error of w. A: planeByRotation(). gate: sigmas, beyond which a direction does not turn the plane and
  /// counts less for w. The covariance returned has w's share, which common alone tells.
  struct Corrected {
    GroundPlane plane;
    Eigen::Matrix3d common;  ///< share of the plane's covariance that is the same in every frame, 1/m^2
    Eigen::Matrix3d kept;    ///< by which errors of the plane given are in the corrected one
  };
  Corrected correct(const GroundPlane& plane, const Eigen::Matrix3d& A, const Others& others, double gate);
  /// What the pair given to correct() last says of w: learned when nothing speaks against it, else forgotten.
  void settle(bool believed);

  RigRotation rotation() const;
  void reset();
  /// After something has turned the camera: what was known of w before is not known any more. vertical: as
  /// for updateVertical(), of a second.
  void startAnew(const RigRotation& vertical);

 private:
  static constexpr int kSize = 10;
  // Slopes among the state.
  static constexpr int kVanishing = 3, kLevel = 6, kMoving = 8;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  /// A direction in the ground plane but for the slope that is a state of its own.
  struct Sloping {
    GroundDirection ground;
    int slope;  // index of the state
    bool isMoving() const { return slope >= kMoving; }
  };
  /// What the errors of a plane are: by_state times those of the state, and noise of this frame.
  struct Joint {
    GroundPlane plane;  // covariance: of the noise
    Eigen::Matrix<double, 3, kSize> by_state;
    Eigen::Matrix3d kept;     // of the errors of the plane before
    Eigen::Matrix3d lasting;  // share of the noise that the next frames have, too
  };
  /// What the directions of a pair say of the state, all at once, as they share the noise of the plane.
  struct Equations {
    Eigen::MatrixXd rows{0, kSize}, tips{0, 3};
    Eigen::VectorXd values, noises, inflations;  // inflation: of the stddev, as the next frames have the same
    Eigen::Matrix3d plane_covariance = Eigen::Matrix3d::Zero();

    void add(const Eigen::RowVector3d& tip, const GroundPlane& plane, const Eigen::Matrix3d& A, int slope,
             double noise, double inflation);
  };
  static std::vector<Sloping> directionsOf(const Others& others);
  struct Innovation {
    double value, variance;
    Eigen::Vector3d gain;  // of the plane
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
  double share_ = 0;                        // that a frame's measurements count for
  double calibrated_variance_ = 0;          // of each component of w, rad^2
  double row_bias_stddev_ = 0;              // pixels
  Vector slope_variance_ = Vector::Zero();  // of each s, rad^2; 0: no direction yet
  Vector prior_ = Vector::Ones();           // variances
  Matrix information_ = Matrix::Zero();
  Vector right_ = Vector::Zero();  // information times value
  // rx, ry, rz, s, c of rx, c of rz, s of level forward and left, s of moving forward and left; rad.
  Vector state_ = Vector::Zero();
  Matrix covariance_ = Matrix::Zero();
  Equations of_last_pair_;
};

}  // namespace uav_landing
