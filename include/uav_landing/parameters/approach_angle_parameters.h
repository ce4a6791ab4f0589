#pragma once

#include "uav_landing/parameters/pixels_per_corner.h"
#include "uav_landing/parameters/window_radius.h"

namespace uav_landing {

// visit(): see parameters.h.

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
  int pixels_per_corner = kUsualPixelsPerCorner;
  int window_radius = kUsualWindowRadius;
  double search_radius = 10.0;
  bool search_at_once = false;
  double min_zncc = 0.75;
  int min_matches = 15;
  double angle_window = 0.5;
  AngleSmoothing angle_smoothing = AngleSmoothing::kAdaptive;
  double min_motion = 5.0;
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
    v.number("hough_threshold", hough_threshold, 5, 1000, "votes",
             "fewest edge pixels on a line (not scan_lines)");
    v.number("min_line_length", min_line_length, 0.01, 1.0, "image heights", "shortest line kept");
    v.number("max_line_gap", max_line_gap, 0.0, 50.0, "px", "gap inside a line that is bridged");
    v.flag("refine_lines", refine_lines, "fit each line to the gradient along it to sub-pixel");
    v.flag("stripe_centres", stripe_centres,
           "for the vanishing point, take the middle of a stripe so narrow that blur pushes its sides apart");
    v.number("ransac_iterations", ransac_iterations, 10, 10000, "",
             "most pairs of lines tried by RANSAC; fewer where many lines agree");
    v.number("ransac_tolerance", ransac_tolerance, 0.1, 20.0, "px",
             "distance by which a line's far end may miss the vanishing point's line; a line that "
             "misses it by more is an outlier");
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
    v.number("corner_count", corner_count, 20, 5000, "corners",
             "Harris corners followed between frames, at most; fewer by pixels_per_corner. Of those that "
             "stereo_depth "
             "kept, where there are any");
    v.number("pixels_per_corner", pixels_per_corner, 1, 10000, "px",
             "of the image for each corner, at least: 256 corners at 320x240; fewer pixels for more corners, "
             "which "
             "tell little more where their windows overlap much");
    v.number("window_radius", window_radius, 2, kLargestWindowRadius, "px",
             "matching window is (2 r + 1) squared");
    v.number("search_radius", search_radius, 1.0, 64.0, "px",
             "searched around the place the previous motion predicts");
    v.flag(
        "search_at_once", search_at_once,
        "search for an unknown motion within one pair, however long it takes; otherwise the search is "
        "spread over several pairs, and no pair takes much longer than others. Use it for recordings of few "
        "pairs");
    v.number("min_zncc", min_zncc, 0.0, 1.0, "", "weakest correlation of a match; a weaker one is rejected");
    v.number("min_matches", min_matches, 6, 1000, "matches", "fewest matches that make a motion");
    v.number("angle_window", angle_window, 0.0, 0.5, "s",
             "images used for the published angle; 0: one step, as always with sliding_window and eq1");
    v.choice("angle_smoothing", angle_smoothing, {"adaptive", "chord"},
             "adaptive: angle of the last step, averaged as far back as the path has been steady; chord: "
             "mean over "
             "angle_window, half of it late");
    v.number("min_motion", min_motion, 2.0, 50.0, "sigma",
             "translation must exceed its own uncertainty by this factor, or no angle is claimed "
             "(no_motion): the camera stands still or is too slow");
    v.flag("use_imu", use_imu,
           "use attitude and angular velocity of an inertial sensor where messages of one come");
    v.number("imu_delay", imu_delay, -1.0, 1.0, "s",
             "latency of the imu: by how much a message's stamp is later than that of an image of "
             "the same moment");
    v.number(
        "imu_wait", imu_wait, 0.0, 1.0, "s",
        "a pair waits this long for the imu message after it, or after its last row, then goes on by those "
        "before it");
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

}  // namespace uav_landing
