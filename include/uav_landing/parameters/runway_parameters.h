#pragma once

namespace uav_landing {

// visit(): see parameters.h.

/// What charts say of the runway, for all stages.
struct RunwayParameters {
  double width = 0;  ///< 0: unknown

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("width", width, 0.0, 200.0, "m",
             "width of the runway, between its outermost long edges. approach_angle rejects edges of another "
             "width, and kalman_height gets a second height from it (fuse_width_height). That height follows "
             "the width, so give one that is right to 0.2 %. 0: unknown; kalman_height then learns the width "
             "while the stereo height is good");
  }
};

}  // namespace uav_landing
