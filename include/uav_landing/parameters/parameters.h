#pragma once

namespace uav_landing {

// Every parameter of the project has its one home here: name, default, range, unit and meaning. The struct is
// what the code reads; visit() is the table from which YAML loading, the ROS parameter server, the range
// check and docs/parameters.md are made. A visitor has number(name, value, min, max, unit, meaning) for int
// and double, flag(name, value, meaning) and choice(name, enum value, {names in enum order}, meaning).

/// Pairing and rectification (nodelet rectify).
struct RectifyParameters {
  bool approximate_sync = false;
  double max_skew = 0.01;
  int queue_size = 5;
  double max_late = 0.3;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.flag("approximate_sync", approximate_sync,
           "pair images whose stamps differ, for cameras without a hardware trigger; else exact stamps");
    v.number("max_skew", max_skew, 0.0, 0.1, "s", "largest difference of the stamps of an approximate pair");
    v.number("queue_size", queue_size, 1, 100, "pairs", "images kept per input while waiting for the others");
    v.number(
        "max_late", max_late, 0.0, 10.0, "s",
        "an image that comes after newer ones is left out when its stamp is behind theirs by up to this; "
        "by more the clock was set back, and everything starts anew; 0: at every step back");
  }
};

enum class MatchingCost { kZncc, kSsd };

/// Sparse stereo and the ground plane (nodelet stereo_depth; paper 3.1, eq 3).
struct StereoDepthParameters {
  int corner_count = 500;
  double harris_k = 0.04;
  double corner_quality = 1e-7;
  double min_corner_distance = 4.0;
  int window_radius = 5;
  MatchingCost matching_cost = MatchingCost::kZncc;
  bool warp_window = true;
  double max_disparity = 0.75;
  double search_radius = 6.0;
  double min_zncc = 0.7;
  double uniqueness = 0.9;
  double left_right_tolerance = 0.7;
  int min_points = 20;
  double plane_tolerance = 0.6;
  bool vertical_disparities = true;
  bool direct_refinement = true;
  bool surface_curvature = true;
  double slope_change_deg = 0.3;
  double disparity_bias_stddev = 0.02;
  double max_roll_deg = 30.0;
  double max_pitch_deg = 30.0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("corner_count", corner_count, 20, 5000, "corners", "Harris corners kept in the left image");
    v.number("harris_k", harris_k, 0.01, 0.2, "", "k of the Harris response");
    v.number("corner_quality", corner_quality, 1e-9, 0.5, "",
             "weakest corner kept, as a share of the strongest response");
    v.number("min_corner_distance", min_corner_distance, 1.0, 50.0, "px", "between two corners");
    v.number("window_radius", window_radius, 2, 15, "px", "matching window is (2 r + 1) squared");
    v.choice("matching_cost", matching_cost, {"zncc", "ssd"},
             "zncc: blind to gain and offset between the cameras; ssd: the paper's");
    v.flag("warp_window", warp_window,
           "shear the window as the ground plane does between the views and refine it to sub-pixel with gain "
           "and offset free; without it: upright windows and a parabola, as in the paper");
    v.number("max_disparity", max_disparity, 0.05, 1.0, "image widths", "largest disparity searched");
    v.number("search_radius", search_radius, 1.0, 64.0, "px",
             "searched to both sides of the disparity that the previous plane predicts");
    v.number("min_zncc", min_zncc, 0.0, 1.0, "", "weakest correlation of a match");
    v.number("uniqueness", uniqueness, 0.1, 1.0, "",
             "a second peak at least this good, as a share of the best, makes a match ambiguous");
    v.number("left_right_tolerance", left_right_tolerance, 0.1, 5.0, "px",
             "largest difference between matching left to right and back");
    v.number("min_points", min_points, 6, 1000, "points", "fewest points that make a ground plane");
    v.number("plane_tolerance", plane_tolerance, 0.1, 10.0, "px",
             "disparity by which a point may be off the plane in the consensus step");
    v.flag("vertical_disparities", vertical_disparities,
           "measure by how many rows matches are off, which shows a bent rig, and make the rows level");
    v.flag("direct_refinement", direct_refinement,
           "refine the plane by aligning the grey levels of the two images over the ground");
    v.flag("surface_curvature", surface_curvature,
           "let the slope of the surface ahead change with the distance where the refinement shows that it "
           "does: "
           "the height is then that above the surface straight below");
    v.number("slope_change_deg", slope_change_deg, 0.001, 10.0, "deg",
             "1 sigma by which the slope of such ground changes over 100 m: vertical curves of runways have "
             "radii of 7.5 km and more, most 20 km");
    v.number("disparity_bias_stddev", disparity_bias_stddev, 0.0, 1.0, "px",
             "1 sigma, in the middle of the image, by which the right camera may have turned since a good "
             "calibration: an error common to all disparities of all pairs");
    v.number("max_roll_deg", max_roll_deg, 1.0, 60.0, "deg", "largest roll that is believed");
    v.number("max_pitch_deg", max_pitch_deg, 1.0, 60.0, "deg", "largest pitch, up or down, that is believed");
  }
};

enum class HoughMethod { kScanLines, kProbabilistic, kStandard };
enum class NormalSource { kFused, kVanishingLine };
enum class FoeMethod { kMotion, kSlidingWindow };
enum class AngleFormula { kGeneral, kEq1 };
enum class AngleSmoothing { kAdaptive, kChord };

/// Lines, vanishing points, focus of expansion, approach angle (nodelet approach_angle; paper 2, eq 1).
struct ApproachAngleParameters {
  bool use_stereo = true;
  HoughMethod hough_method = HoughMethod::kScanLines;
  double canny_low = 40, canny_high = 110;
  int hough_threshold = 15;
  double min_line_length = 0.04;
  double max_line_gap = 4.0;
  bool refine_lines = true;
  bool stripe_centres = true;
  int ransac_iterations = 500;
  double ransac_tolerance = 1.5;
  int min_lines = 3;
  double max_yaw_deg = 30.0;
  double max_elevation_deg = 30.0;
  double runway_straightness_deg = 0.15;
  double level_roll_stddev_deg = 10.0;
  NormalSource normal_source = NormalSource::kFused;
  FoeMethod foe_method = FoeMethod::kMotion;
  bool remove_rotation = true;
  AngleFormula angle_formula = AngleFormula::kGeneral;
  int corner_count = 400;
  int window_radius = 5;
  double search_radius = 10.0;
  double min_zncc = 0.75;
  int min_matches = 15;
  double angle_window = 0.5;
  AngleSmoothing angle_smoothing = AngleSmoothing::kAdaptive;
  double min_motion = 5.0;
  double runway_width = 0;
  bool use_imu = true;
  double imu_delay = 0;
  double imu_wait = 0.02;
  double imu_max_gap = 0.1;
  double imu_attitude_stddev_deg = 1.0;
  double imu_rate_stddev_deg = 0.3;
  double imu_rate_bias_deg = 0.1;
  double runway_slope_stddev_deg = 0.5;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.flag(
        "use_stereo", use_stereo,
        "ground normal and depth from stereo_depth; without: from the vanishing points alone, as the paper");
    v.choice("hough_method", hough_method, {"scan_lines", "probabilistic", "standard"},
             "scan_lines: edges are followed from scan lines across the image, many times faster than the "
             "Hough transforms of all edge pixels, the paper's");
    v.number("canny_low", canny_low, 1.0, 1000.0, "grey/px", "weak edges, 3x3 Sobel scale");
    v.number("canny_high", canny_high, 1.0, 1000.0, "grey/px", "strong edges");
    v.number("hough_threshold", hough_threshold, 5, 1000, "votes", "fewest edge pixels on a line");
    v.number("min_line_length", min_line_length, 0.01, 1.0, "image heights", "shortest line kept");
    v.number("max_line_gap", max_line_gap, 0.0, 50.0, "px", "gap inside a line that is bridged");
    v.flag("refine_lines", refine_lines, "fit each line to the gradient along it to sub-pixel");
    v.flag("stripe_centres", stripe_centres,
           "for the vanishing point, take the middle of a stripe so narrow that blur pushes its sides apart");
    v.number("ransac_iterations", ransac_iterations, 10, 10000, "",
             "most pairs of lines tried; fewer where many lines agree");
    v.number("ransac_tolerance", ransac_tolerance, 0.1, 20.0, "px",
             "distance by which a line's far end may miss the vanishing point's line");
    v.number("min_lines", min_lines, 2, 100, "lines",
             "fewest lines that make a vanishing point; with 2 any two lines are believed");
    v.number("max_yaw_deg", max_yaw_deg, 1.0, 80.0, "deg",
             "lines that meet farther to the side are not along the runway");
    v.number("max_elevation_deg", max_elevation_deg, 1.0, 60.0, "deg",
             "lines that meet farther above or below the optical axis are not along the runway");
    v.number("runway_straightness_deg", runway_straightness_deg, 0.0, 5.0, "deg",
             "1 sigma by which the runway's own slope and curve turn its vanishing point");
    v.number("level_roll_stddev_deg", level_roll_stddev_deg, 0.1, 90.0, "deg",
             "1 sigma of the paper's assumption that the rig is level");
    v.choice(
        "normal_source", normal_source, {"fused", "vanishing_line"},
        "ground normal of the angle: stereo plane and vanishing points by covariance, or the latter alone");
    v.choice("foe_method", foe_method, {"motion", "sliding_window"},
             "motion: robust rotation and translation; sliding_window: the paper's 3x3 vote");
    v.flag("remove_rotation", remove_rotation,
           "take the rotation between the frames out of the image velocities first (sliding_window only)");
    v.choice("angle_formula", angle_formula, {"general", "eq1"}, "asin(n.t) or the paper's eq (1)");
    v.number("corner_count", corner_count, 20, 5000, "corners", "Harris corners followed between frames");
    v.number("window_radius", window_radius, 2, 15, "px", "matching window is (2 r + 1) squared");
    v.number("search_radius", search_radius, 1.0, 64.0, "px",
             "searched around the place the previous motion predicts");
    v.number("min_zncc", min_zncc, 0.0, 1.0, "", "weakest correlation of a match");
    v.number("min_matches", min_matches, 6, 1000, "matches", "fewest matches that make a motion");
    v.number("angle_window", angle_window, 0.0, 0.5, "s",
             "images used for the published angle; 0: one step, as always with sliding_window and eq1");
    v.choice("angle_smoothing", angle_smoothing, {"adaptive", "chord"},
             "adaptive: angle of the last step, averaged as far back as the path has been steady; chord: "
             "mean over "
             "angle_window, half of it late");
    v.number("min_motion", min_motion, 2.0, 50.0, "sigma",
             "translation must exceed its own uncertainty by this factor, or no angle is claimed");
    v.number("runway_width", runway_width, 0.0, 200.0, "m",
             "between the outermost long edges along the runway; edges of another width are not believed. 0: "
             "not known");
    v.flag("use_imu", use_imu,
           "use attitude and angular velocity of an inertial sensor where messages of one come");
    v.number("imu_delay", imu_delay, -1.0, 1.0, "s",
             "by which an imu message's stamp is later than that of an image of the same moment");
    v.number("imu_wait", imu_wait, 0.0, 1.0, "s",
             "a pair waits this long for the imu message after it, then goes on by those before it");
    v.number("imu_max_gap", imu_max_gap, 0.001, 1.0, "s",
             "longest time between two imu messages, or after the newest one, that is bridged");
    v.number("imu_attitude_stddev_deg", imu_attitude_stddev_deg, 0.01, 20.0, "deg",
             "1 sigma of the imu's pitch and roll where its messages do not tell; slow errors included");
    v.number("imu_rate_stddev_deg", imu_rate_stddev_deg, 0.001, 20.0, "deg/s",
             "1 sigma of the imu's angular velocity where its messages do not tell");
    v.number("imu_rate_bias_deg", imu_rate_bias_deg, 0.0, 20.0, "deg/s",
             "1 sigma of the constant error of the imu's angular velocity, besides");
    v.number("runway_slope_stddev_deg", runway_slope_stddev_deg, 0.0, 5.0, "deg",
             "1 sigma by which the ground ahead slopes, along and across: for the ground normal from an "
             "imu's attitude");
  }
};

enum class HeightSource { kPlane, kPoints };
enum class ReconstructionAngle { kPitch, kApproach };

/// Reconstruction and the height filter (nodelet kalman_height; paper 3.2, 3.3, eqs 4-8).
struct KalmanHeightParameters {
  HeightSource height_source = HeightSource::kPlane;
  ReconstructionAngle reconstruction_angle = ReconstructionAngle::kPitch;
  bool fuse_vanishing_point = true;
  double vanishing_point_gate = 3.0;
  bool fuse_imu = true;
  bool use_motion = true;
  bool average_attitude = true;
  double acceleration_stddev = 1.5;
  double initial_speed_stddev = 5.0;
  double height_model_error = 0.001;
  double gate = 5.0;
  double max_age = 0.3;
  double reset_timeout = 1.0;
  double max_height_error = 0.05;
  double min_height_error = 0.15;
  double max_angle_stddev_deg = 1.0;
  bool fuse_width_height = true;
  double known_runway_width = 0;
  bool rig_watch = true;
  double rig_memory = 60.0;
  double max_rig_rotation_deg = 0.2;
  bool integrity_monitor = true;
  double integrity_risk = 1e-5;
  double fault_probability = 1e-3;
  double false_alarm_rate = 1e-5;
  double max_deceleration = 3.0;
  double recovery_time = 1.0;
  double alert_limit = 0.15;
  double alert_limit_relative = 0.05;
  double unwatched_scale_error = 0.02;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.choice("height_source", height_source, {"plane", "points"},
             "height of the fitted plane, or the average of eq (5) over the points as in the paper");
    v.choice("reconstruction_angle", reconstruction_angle, {"pitch", "approach"},
             "angle in eqs (4) and (5): pitch levels the camera; approach is the paper to the letter");
    v.flag("fuse_vanishing_point", fuse_vanishing_point,
           "correct the stereo plane's pitch with the vanishing point");
    v.number("vanishing_point_gate", vanishing_point_gate, 1.0, 20.0, "sigma",
             "a vanishing point that disagrees more with the stereo plane is left out");
    v.flag("fuse_imu", fuse_imu,
           "correct the stereo plane's pitch and roll, and watch the rig, with the attitude of an imu");
    v.flag("use_motion", use_motion, "measure the vertical speed by the motion between the frames as well");
    v.flag(
        "average_attitude", average_attitude,
        "pitch and roll of the last second's pairs along the rotation between them; else of each pair alone");
    v.number("acceleration_stddev", acceleration_stddev, 0.01, 50.0, "m/s^2",
             "1 sigma of the random vertical acceleration, eq (7)");
    v.number("initial_speed_stddev", initial_speed_stddev, 0.1, 100.0, "m/s",
             "1 sigma of the initial vertical speed, which starts at 0");
    v.number("height_model_error", height_model_error, 0.0, 0.1, "of height",
             "1 sigma by which the surface below differs from the plane seen ahead; does not average out");
    v.number("gate", gate, 1.0, 20.0, "sigma", "largest normalised innovation that is believed");
    v.number("max_age", max_age, 0.05, 10.0, "s", "without a pair for this long the status is lost");
    v.number("reset_timeout", reset_timeout, 0.1, 60.0, "s",
             "without an accepted measurement for this long the filter starts anew");
    v.number("max_height_error", max_height_error, 0.001, 1.0, "of height",
             "3 sigma above this share of the height (and min_height_error) is not valid");
    v.number("min_height_error", min_height_error, 0.001, 10.0, "m",
             "3 sigma below this is valid at any height");
    v.number("max_angle_stddev_deg", max_angle_stddev_deg, 0.01, 20.0, "deg",
             "1 sigma of the approach angle above this is not valid");
    v.flag("fuse_width_height", fuse_width_height,
           "use the height from the runway's width: where stereo has none, and, when known_runway_width is "
           "set, together with stereo if both agree");
    v.number("known_runway_width", known_runway_width, 0.0, 200.0, "m",
             "between the outermost long edges of the runway, for the height; 0: learned while the stereo "
             "height is good");
    v.flag(
        "rig_watch", rig_watch,
        "estimate how far the right camera has turned since the calibration, and correct the plane for it");
    v.number("rig_memory", rig_memory, 1.0, 36000.0, "s",
             "for how long what was seen of the rig's rotation counts; shorter follows a rig that moves");
    v.number("max_rig_rotation_deg", max_rig_rotation_deg, 0.01, 5.0, "deg",
             "a rotation of the right camera that is certainly beyond this is not valid");
    v.flag("integrity_monitor", integrity_monitor,
           "test the sources of the height against each other and compute the height's protection level");
    v.number("integrity_risk", integrity_risk, 1e-12, 0.1, "per pair",
             "probability that the error exceeds the protection level");
    v.number("fault_probability", fault_probability, 1e-9, 1.0, "per pair",
             "prior probability that one source is wrong and no test says so; 1: the protection level holds "
             "with integrity_risk even then");
    v.number("false_alarm_rate", false_alarm_rate, 1e-12, 0.1, "per test and pair",
             "probability that a test fails without a fault, as far as the claimed variances are true");
    v.number(
        "max_deceleration", max_deceleration, 0.01, 1000.0, "m/s^2",
        "by which the aircraft can change its speed over the ground: a picture that stands still sooner is "
        "that of a camera that hangs, a speed that seems to jump says that stamps are wrong");
    v.number("recovery_time", recovery_time, 0.0, 60.0, "s",
             "after contradictions that took the height away none may come for this long before it is valid "
             "again; 0: it is as soon as the tests pass");
    v.number("alert_limit", alert_limit, 0.001, 100.0, "m",
             "the height is not valid when its protection level exceeds this and alert_limit_relative");
    v.number("alert_limit_relative", alert_limit_relative, 0.0, 1.0, "of height", "see alert_limit");
    v.number(
        "unwatched_scale_error", unwatched_scale_error, 0.0, 0.5, "of height",
        "largest error of a scale common to all heights, such as that of the baseline, which nothing can "
        "see: in the protection level by assumption");
  }
};

/// The overlay picture (nodelet overlay).
struct OverlayParameters {
  int scale = 0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("scale", scale, 0, 4, "", "picture enlarged by this factor; 0: at least 640 pixels wide");
  }
};

/// One parameter set for the whole chain; each member is a section of config/*.yaml.
struct Parameters {
  RectifyParameters rectify;
  StereoDepthParameters stereo_depth;
  ApproachAngleParameters approach_angle;
  KalmanHeightParameters kalman_height;
  OverlayParameters overlay;

  /// Calls v(section name, parameter struct) for every section.
  template <class Visitor>
  void visitSections(Visitor&& v) {
    v("rectify", rectify);
    v("stereo_depth", stereo_depth);
    v("approach_angle", approach_angle);
    v("kalman_height", kalman_height);
    v("overlay", overlay);
  }
};

}  // namespace uav_landing
