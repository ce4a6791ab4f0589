#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/results/attitude_prior.h"
#include "uav_landing/results/consistency_test.h"

namespace uav_landing {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rotation of the right camera against its calibration, as a small rotation vector (see rig_rotation.h).
struct RigRotation {
  Eigen::Vector3d w = Eigen::Vector3d::Constant(kUnknown);           ///< rectified axes, rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kUnknown);  ///< rad^2
  int count = 0;                                                     ///< number of corners that measured it

  bool known() const { return w.allFinite() && covariance.allFinite(); }
  /// The part that vertical disparities show, whatever ry is: (rx, rz), rad.
  Eigen::Vector2d pitchAndRoll() const { return {w.x(), w.z()}; }
  /// Covariance of pitchAndRoll(), rad^2.
  Eigen::Matrix2d pitchAndRollCovariance() const {
    return (Eigen::Matrix2d() << covariance(0, 0), covariance(0, 2), covariance(2, 0), covariance(2, 2))
        .finished();
  }
};

/// Place of the right camera against its calibration: it is at b (1, t.x, t.y) from the left one, in
/// rectified axes (right, down, forward). It differs from 0 when images were not taken at the same time, or
/// when a focal length is not as calibrated.
struct BaselineDirection {
  Eigen::Vector2d t = Eigen::Vector2d::Constant(kUnknown);           ///< down, forward over the baseline, rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kUnknown);  ///< rad^2

  bool known() const { return t.allFinite() && covariance.allFinite(); }
};

/// Readout time of the cameras, estimated from what moves in the images. Unknown when one is given.
struct ReadoutEstimate {
  double time = kUnknown;      ///< s, from the first line to the last
  double variance = kUnknown;  ///< s^2; an error is the same in all pairs

  /// No time is given, and nothing speaks against a global shutter.
  static ReadoutEstimate global() { return {0, 0}; }
  bool given() const { return !(variance >= 0); }
  /// Whether a time is estimated: none is given, and the shutter is not taken as global.
  bool known() const { return variance > 0; }
};
/// Advice for an estimate that is certain and not that of a global shutter; else empty.
std::string adviceOn(const ReadoutEstimate& readout);

/// Result of the stereo branch (paper 3.1) for one pair. Mirrors StereoDepth.msg.
struct StereoDepthResult {
  /// One matched corner. Coordinates in the rectified left image, pixels.
  struct Point {
    double u = kUnknown, v = kUnknown;
    double disparity = kUnknown;         ///< pixels, (u_l - u_r) - (cx_l - cx_r)
    double disparity_stddev = kUnknown;  ///< pixels, of the match itself
    bool on_plane = false;               ///< agrees with the ground plane
  };
  double stamp = 0;  ///< of the left image, s
  Failure failure;   ///< set when there is no plane
  int corners = 0;   ///< number of corners looked for in the right image
  std::vector<Point> points;
  GroundPlane plane;
  /// Share of the plane's covariance that comes from vertical disparities, and later from row times, 1/m^2.
  /// It is nearly the same in every pair.
  Eigen::Matrix3d row_covariance = Eigen::Matrix3d::Zero();
  /// With row times: plane_rate is how fast g changes according to the pairs before, 1/m/s. It carried g to
  /// the stamp. plane_by_rate is the derivative of g by that rate, s. Both are zero when all rows are exposed
  /// at once. When no readout time is given, nothing was carried, and the derivative is that of a readout of
  /// 1 s.
  Eigen::Vector3d plane_rate = Eigen::Vector3d::Zero();
  Eigen::Matrix3d plane_by_rate = Eigen::Matrix3d::Zero();
  /// Share of the plane's covariance that is not noise of the images, above 0 and up to 1. The covariance is
  /// taken without row_covariance and without the bias of disparities. Part of this error is the same in the
  /// next pairs. Not known without direct refinement.
  double lasting_share = kUnknown;
  /// Tangent of the surface straight below the camera, for the height. The plane is that of the surface
  /// ahead. Not known when too little of the ground is seen.
  GroundPlane below;
  /// Mean change of the surface's slope over distance, 1/m, positive in a sag, and its variance, 1/m^2. Known
  /// when below is.
  double curvature = kUnknown, curvature_variance = kUnknown;
  double residual_stddev = kUnknown;  ///< of the points on the plane, pixels of disparity
  /// Variance of the surface ahead about the plane, unbiased (may be < 0), m^2.
  double surface_variance = kUnknown;
  bool from_search = false;  ///< the plane was found without that of the previous pair
  double skew = 0;           ///< stamp of right minus left image, seconds
  /// Rotation of the rig by the vertical disparities of this pair alone. It has only random errors.
  RigRotation vertical_rotation;
  /// The baseline by the vertical disparities of this pair alone. Errors that all pairs may have are
  /// included.
  BaselineDirection baseline_direction;
  /// Share of the corners matched along the rows that are found again when they may also leave the row. Wrong
  /// matches mostly are not. Not known when nothing was measured.
  double row_agreement = kUnknown;
  /// 1 sigma of the constant disparity error that the plane's covariance contains, pixels.
  double disparity_bias_stddev = 0;
  /// 1 sigma of the vertical disparities that the calibration's lenses leave, pixels.
  double row_bias_stddev = 0;
  /// Share of the image blocks over the ground that look alike in both images and lie on one plane. Not known
  /// without direct refinement.
  double photometric_agreement = kUnknown;
  /// The image is the same as in the pair before, bit by bit. Sensors have noise, but a frozen driver does
  /// not.
  bool left_repeated = false, right_repeated = false;
};

/// Sources of the runway's centre line. One of them at a time may be wrong without anything showing it.
/// - kLeftEdge, kRightEdge: the long outermost edges.
/// - kStripe: the line along the middle.
/// - kMarks: all other paint, such as the bars of the threshold.
/// - kDirection: the vanishing point.
/// - kWholeRunway: the assumption that the outermost edges are not those of half a runway.
enum class CentreSource { kLeftEdge, kRightEdge, kStripe, kMarks, kDirection, kWholeRunway };
constexpr int kCentreSources = 6;

/// A position across the runway without each source of it. Unknown where nothing else tells the position.
struct CentreSolutions {
  struct Solution {
    double value = kUnknown, variance = kUnknown;
  };
  std::array<Solution, kCentreSources> without;
  Solution& operator[](CentreSource source) { return without[static_cast<int>(source)]; }
  const Solution& operator[](CentreSource source) const { return without[static_cast<int>(source)]; }
};

/// Result of the monocular branch (paper 2) for one pair. Mirrors ApproachAngle.msg.
struct ApproachAngleResult {
  struct Line {
    Eigen::Vector2d a, b;  ///< end points, pixels of the rectified image
    bool inlier = false;   ///< passes through the vanishing point
  };
  struct View {
    std::vector<Line> lines;
    Failure failure;
    Eigen::Vector3d vanishing_direction = Eigen::Vector3d::Constant(kUnknown);   ///< unit, towards +z
    Eigen::Matrix3d vanishing_covariance = Eigen::Matrix3d::Constant(kUnknown);  ///< rad^2, rank 2
  };
  /// Error of the plane vector of stereo, because the camera turned between the rows of the image.
  struct PlaneByTurns {
    Eigen::Vector3d mean =
        Eigen::Vector3d::Zero();  ///< as an inertial sensor measured it, 1/m; to be taken off
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of what stays, 1/m^2
  };
  /// Camera motion over an interval that ends at this frame.
  struct Motion {
    Failure failure;
    double duration = kUnknown;  ///< s
    int matches = 0, inliers = 0;
    /// Rotation vector w of R = exp(w), rad. A point at rest moves as x_now = R (x_then - c), with c the
    /// movement of the camera.
    Eigen::Vector3d rotation = Eigen::Vector3d::Constant(kUnknown);
    /// Movement of the camera in the current frame, over the current height: t / h.
    Eigen::Vector3d translation_over_height = Eigen::Vector3d::Constant(kUnknown);
    /// Rate of turn now, rad/s, in the sense of `rotation`. Not known without row times, and where vibration
    /// hides it. The window has none but where it is the step.
    Eigen::Vector3d turn_rate = Eigen::Vector3d::Constant(kUnknown);
    Matrix6d covariance = Matrix6d::Constant(kUnknown);  ///< of (rotation, translation_over_height)
    double angle = kUnknown;           ///< approach angle over the interval, rad, positive descending
    double angle_variance = kUnknown;  ///< rad^2, includes the normal's
    /// 1 sigma by which rows that move on their own (vibration) move the angle, and the largest one that the
    /// angle's variance covers; rad. Unknown where rig/readout_time is 0.
    double row_motion = kUnknown, row_motion_limit = kUnknown;
    /// Whether rows move the angle by more than that. Such a motion tells no angle.
    bool rowsMove() const { return row_motion > row_motion_limit; }
    /// Ground normal by what moves in the image, unit, and its covariance (rad^2, rank 2). It is independent
    /// of stereo except for the depth of points off the plane. Unknown when the motion does not show it.
    Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);
    Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Constant(kUnknown);
  };
  /// Position over the runway, of this pair alone. Earlier frames only tell which edges are the runway's.
  struct Runway {
    Failure failure;                                     ///< set when the centre line is not known
    double y = kUnknown, y_variance = kUnknown;          ///< camera left of the centre line, over h
    double width = kUnknown, width_variance = kUnknown;  ///< between the outermost edges, over h
    Failure threshold_failure;                           ///< set when the threshold is not seen
    double x = kUnknown, x_variance = kUnknown;  ///< camera past the threshold, over h; negative before it
    double x_systematic_variance = 0;            ///< part of x_variance that is the same error in every frame
    CentreSolutions y_without;                   ///< y without each source of it, over h
  };
  /// Position over the runway by the runway's outline in the image and its size in charts (sighting.h).
  struct Sight {
    Failure failure;  ///< set when the outline is not seen, or gives no position
    /// Past the threshold, left of the centre line, above the plane of the runway's surface; m, m^2.
    Eigen::Vector3d position = Eigen::Vector3d::Constant(kUnknown);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kUnknown);
    double yaw = kUnknown, yaw_variance = kUnknown;        ///< left of the landing direction, rad, rad^2
    double width = kUnknown, width_variance = kUnknown;    ///< of the runway's surface, m, m^2
    double length = kUnknown, length_variance = kUnknown;  ///< the same for the length, m, m^2
    /// The height without one of the elements: the chart's width, its length, the ground's normal; m, m^2.
    Eigen::Vector3d height_without = Eigen::Vector3d::Constant(kUnknown);
    Eigen::Vector3d variance_without = Eigen::Vector3d::Constant(kUnknown);
    /// By how much the height grows with the chart's sizes, m for an error as large as the sizes; the most
    /// for width, length, or both.
    double height_by_chart = kUnknown;
    /// Disparity of the runway itself, px, px^2. Not known where stereo does not show the runway.
    /// height_by_bias: by how much the height changes with one standard deviation of the bias that all
    /// disparities have in common, m; 0 without a disparity.
    double disparity = kUnknown, disparity_variance = kUnknown, height_by_bias = 0;
    /// Size of the surface by stereo, over the chart's; unknown without stereo.
    double size_over_chart = kUnknown, size_over_chart_variance = kUnknown;
  };
  double stamp = 0;
  Failure failure;  ///< set when there is no approach angle
  View left, right;
  /// Vanishing point of the runway from both views, a unit vector in the left camera's frame, and its
  /// covariance, rad^2. Independent of stereo.
  Eigen::Vector3d vanishing_direction = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d vanishing_covariance = Eigen::Matrix3d::Constant(kUnknown);
  /// Probability that this direction belongs to something else: a street, a field, a shore. 0 to 1. The
  /// covariance of the direction holds if it is the runway's.
  double other_runway_probability = 1;
  /// Ground normal from the vanishing points alone (level rig, roll variance large), left frame; rad^2.
  Eigen::Vector3d n_vp = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d n_vp_covariance = Eigen::Matrix3d::Constant(kUnknown);
  /// Ground normal fused from stereo and the vanishing points, in the left frame, and its covariance, rad^2.
  /// The angles here refer to it.
  Eigen::Vector3d n = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d n_covariance = Eigen::Matrix3d::Constant(kUnknown);
  Motion step;    ///< from the previous frame
  Motion window;  ///< over up to angle_window s; its angle is the current one of the path (angle_smoothing)
  Eigen::Vector2d foe = Eigen::Vector2d::Constant(kUnknown);  ///< of the step, px, px^2
  Eigen::Matrix2d foe_covariance = Eigen::Matrix2d::Constant(kUnknown);
  Runway runway;
  Sight sight;
  PlaneByTurns plane_by_turns;
  /// Estimate by the pairs before. All numbers of this pair are corrected by it, and their claims contain its
  /// error.
  ReadoutEstimate readout;
  /// Prior of an inertial sensor. The slope of the ground is in the normal's covariance.
  AttitudePrior imu;
};
/// Why an inertial sensor does not tell how rows move on their own; empty when they do not, or when there is
/// no such sensor.
std::string adviceOnImu(const ApproachAngleResult& result);

enum class Status { kSearching = 0, kTracking = 1, kCoasting = 2, kLost = 3 };
const char* toString(Status status);

/// Source of a height.
enum class HeightOrigin { kNone, kStereo, kWidth, kGeometry, kPrediction };
/// For example "geometry"; "" for kNone.
const char* toString(HeightOrigin origin);

/// The estimate for one pair, of the left rectified camera. Mirrors LandingEstimate.msg.
struct LandingResult {
  double stamp = 0;
  Status status = Status::kSearching;
  Failure failure;  ///< why the status is not tracking, or why valid is false
  bool height_valid = false;
  bool angle_valid = false;
  bool valid() const { return height_valid && angle_valid; }
  double height = kUnknown, height_variance = kUnknown;          ///< filtered, m, m^2
  double raw_height = kUnknown, raw_height_variance = kUnknown;  ///< measured on this pair alone
  double points_height = kUnknown;  ///< eqs (4), (5) averaged over the points on the plane, m
  double vertical_speed = kUnknown, vertical_speed_variance = kUnknown;  ///< up, m/s
  /// Angle of the path below the ground's horizontal, rad, rad^2; raw: of the last step alone.
  double approach_angle = kUnknown, approach_angle_variance = kUnknown;
  double raw_approach_angle = kUnknown, raw_approach_angle_variance = kUnknown;
  /// Positive with the nose up, the right side down, and to the left of the runway; rad, rad^2.
  double pitch = kUnknown, pitch_variance = kUnknown;
  double roll = kUnknown, roll_variance = kUnknown;
  double yaw = kUnknown, yaw_variance = kUnknown;  ///< unknown until the runway direction is certain
  Failure yaw_failure;                             ///< why the yaw is not known
  double other_runway_probability = 1;  ///< probability that the direction seen is not the runway's, 0 to 1
  double x = kUnknown, x_variance = kUnknown;  ///< past the threshold, m; unknown until that is seen
  double y = kUnknown, y_variance = kUnknown;  ///< left of the centre line, m; unknown until that is seen
  double y_protection_level = kUnknown;        ///< m; unknown while nothing checks the edges
  /// Height of the point above the plane of the runway's surface, m, m^2. Unknown until the runway is found.
  double height_above_runway = kUnknown, height_above_runway_variance = kUnknown;
  bool height_above_runway_known = false;                  ///< its protection level is within its limit
  double height_above_runway_protection_level = kUnknown;  ///< m; holds for a wrong chart, too
  double height_above_runway_limit = kUnknown;             ///< largest protection level that is tolerated, m
  /// Source of the height above the runway, or of the height when there is none above the runway.
  HeightOrigin height_origin = HeightOrigin::kNone;
  Failure runway_failure;  ///< how the runway contradicts the chart
  void forgetHeightAboveRunway() {
    height_above_runway = height_above_runway_variance = kUnknown;
    height_above_runway_protection_level = height_above_runway_limit = kUnknown;
    height_above_runway_known = false;
  }
  void forgetPosition() {
    x = x_variance = y = y_variance = y_protection_level = kUnknown;
    forgetHeightAboveRunway();
  }
  double runway_width = kUnknown, runway_width_variance = kUnknown;  ///< of this pair, m
  double width_height = kUnknown, width_height_variance = kUnknown;  ///< from the runway's width, m, m^2
  Eigen::Vector2d foe = Eigen::Vector2d::Constant(kUnknown);
  /// Mean of the last step, in the left camera's frame now, m/s, rad/s. Unknown when no step is believed. The
  /// velocity has the height's scale, so it is unknown where the height is not valid.
  Eigen::Vector3d velocity = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Constant(kUnknown);
  Matrix6d twist_covariance = Matrix6d::Constant(kUnknown);  ///< of both, velocity first
  void forgetVelocity();
  double speed() const { return velocity.norm(); }               ///< along the path, m/s
  double speedVariance() const;                                  ///< m^2/s^2
  double innovation = kUnknown, innovation_variance = kUnknown;  ///< of the raw height
  bool rejected = false;                                         ///< the raw height failed the gate
  int consecutive_rejections = 0;
  int resets = 0;                             ///< filter resets since start
  RigRotation rig_rotation;                   ///< unknown when rig_watch is off
  double height_protection_level = kUnknown;  ///< m, see solution_separation.h
  double height_alert_limit = kUnknown;       ///< largest protection level that is tolerated, m
  std::string protection_source;              ///< source that gives the protection level
  std::vector<TestResult> tests;  ///< tests of the sources against each other; empty when switched off
};

}  // namespace uav_landing
