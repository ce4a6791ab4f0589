#pragma once

#include "uav_landing/parameters/pixels_per_corner.h"
#include "uav_landing/parameters/window_radius.h"

namespace uav_landing {

// visit(): see parameters.h.

enum class MatchingCost { kZncc, kSsd };

/// Sparse stereo and the ground plane (nodelet stereo_depth; paper 3.1, eq 3).
struct StereoDepthParameters {
  int corner_count = 500;
  int pixels_per_corner = kUsualPixelsPerCorner;
  double harris_k = 0.04;
  double corner_quality = 1e-7;
  double min_corner_distance = 4.0;
  int window_radius = kUsualWindowRadius;
  MatchingCost matching_cost = MatchingCost::kZncc;
  bool warp_window = true;
  double max_disparity = 0.75;
  double search_radius = 6.0;
  bool search_at_once = false;
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
  double row_bias_stddev = 0.03;
  double max_roll_deg = 30.0;
  double max_pitch_deg = 30.0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("corner_count", corner_count, 20, 5000, "corners",
             "Harris corners kept in the left image, at most; fewer by pixels_per_corner. Fewer "
             "take less computing time");
    v.number("pixels_per_corner", pixels_per_corner, 1, 10000, "px",
             "of the image for each corner, at least: 256 corners at 320x240; fewer pixels for more corners, "
             "which "
             "tell little more where their windows overlap much");
    v.number("harris_k", harris_k, 0.01, 0.2, "", "k of the Harris response");
    v.number("corner_quality", corner_quality, 1e-9, 0.5, "",
             "weakest corner kept, as a share of the strongest response");
    v.number("min_corner_distance", min_corner_distance, 1.0, 50.0, "px", "between two corners");
    v.number("window_radius", window_radius, 2, kLargestWindowRadius, "px",
             "matching window is (2 r + 1) squared");
    v.choice("matching_cost", matching_cost, {"zncc", "ssd"},
             "zncc: blind to differences in brightness (gain, offset, exposure) between the "
             "cameras; ssd: the paper's");
    v.flag("warp_window", warp_window,
           "shear the window as the ground plane does between the views and refine it to sub-pixel with gain "
           "and offset free; without it: upright windows and a parabola, as in the paper");
    v.number("max_disparity", max_disparity, 0.05, 1.0, "image widths", "largest disparity searched");
    v.number("search_radius", search_radius, 1.0, 64.0, "px",
             "searched to both sides of the disparity that the previous plane predicts");
    v.flag(
        "search_at_once", search_at_once,
        "search for an unknown plane within one pair, however long it takes; otherwise the search is spread "
        "over several pairs, and no pair takes much longer than others. Use it for recordings of few pairs");
    v.number("min_zncc", min_zncc, 0.0, 1.0, "", "weakest correlation of a match; a weaker one is rejected");
    v.number("uniqueness", uniqueness, 0.1, 1.0, "",
             "a second peak at least this good, as a share of the best, makes a match ambiguous, as "
             "on a repeated pattern; the match is rejected");
    v.number("left_right_tolerance", left_right_tolerance, 0.1, 5.0, "px",
             "largest difference between matching left to right and back; a match that differs more "
             "is rejected");
    v.number("min_points", min_points, 6, 1000, "points", "fewest points that make a ground plane");
    v.number("plane_tolerance", plane_tolerance, 0.1, 10.0, "px",
             "disparity by which a point may be off the plane in the consensus step (RANSAC); a "
             "point farther off is an outlier");
    v.flag("vertical_disparities", vertical_disparities,
           "measure by how many rows matches are off, which shows a bent rig, and make the rows level");
    v.flag("direct_refinement", direct_refinement,
           "refine the plane by aligning the grey levels of the two images over the ground");
    v.flag("surface_curvature", surface_curvature,
           "let the slope of the surface ahead change with the distance where the disparities show that it "
           "does: "
           "the height is then that above the surface straight below");
    v.number("slope_change_deg", slope_change_deg, 0.001, 10.0, "deg",
             "1 sigma by which the slope of such ground changes over 100 m: vertical curves of runways have "
             "radii of 7.5 km and more, most 20 km");
    v.number("disparity_bias_stddev", disparity_bias_stddev, 0.0, 1.0, "px",
             "1 sigma, in the middle of the image, by which the right camera may have turned since a good "
             "calibration: an error common to all disparities of all pairs");
    v.number(
        "row_bias_stddev", row_bias_stddev, 0.0, 1.0, "px",
        "1 sigma of the vertical disparities that a good calibration's lenses leave in the middle of the "
        "image, and as much of their inclination at a third of the focal length beside it");
    v.number("max_roll_deg", max_roll_deg, 1.0, 60.0, "deg", "largest roll that is believed");
    v.number("max_pitch_deg", max_pitch_deg, 1.0, 60.0, "deg", "largest pitch, up or down, that is believed");
  }
};

}  // namespace uav_landing
