#pragma once

#include <algorithm>
#include <sstream>

#include "uav_landing/base/failure.h"

namespace uav_landing {

// visit(): see parameters.h.

/// The runway as charts describe it, for all stages.
struct RunwayParameters {
  double width = 0, length = 0;  ///< m; 0: unknown
  double side_stripe_inset = 0;  ///< m
  bool paved = true;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number(
        "width", width, 0.0, 200.0, "m",
        "width of the runway's surface, as charts have it. From afar it gives the height above the runway, "
        "and kalman_height gets a second height from it (fuse_width_height). It learns the width itself "
        "while the stereo height is good. 0: unknown");
    v.number(
        "length", length, 0.0, 10000.0, "m",
        "length of the runway's surface, as charts have it. With the width it gives the height above the "
        "runway from afar. What is longer is not the runway. 0: unknown");
    v.number("side_stripe_inset", side_stripe_inset, 0.0, 20.0, "m",
             "by how much the painted stripes along the sides lie inside the runway's width. The edges that "
             "show may be either. 0: unknown; up to 3 % of the width, and 1.25 m");
    v.flag("paved", paved,
           "false for a strip of grass: it has a direction only where its two edges show, and other lines "
           "that meet are not believed");
  }

  /// Largest distance of the side stripes from the edges of the runway's width, m.
  double largestInset() const {
    return side_stripe_inset > 0 ? side_stripe_inset : std::min(0.03 * width, 1.25);
  }

  /// Refuses what no runway can have.
  Failure check() const {
    std::ostringstream problem;
    if (length > 0 && length < width)
      problem << "runway/length: " << length << " m, expected at least runway/width, " << width << " m";
    else if (width > 0 && 2 * side_stripe_inset >= width)
      problem << "runway/side_stripe_inset: " << side_stripe_inset
              << " m, expected less than half of runway/width, " << width << " m";
    else
      return {};
    return {Reason::kInputInvalid, problem.str()};
  }
};

}  // namespace uav_landing
