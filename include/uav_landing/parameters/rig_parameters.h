#pragma once

namespace uav_landing {

// visit(): see parameters.h.

/// Limits of what is believed of the calibration of the cameras, for all stages.
struct RigParameters {
  double max_principal_point_offset = 0.2;
  double max_baseline = 50.0;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("max_principal_point_offset", max_principal_point_offset, 0.05, 5.0, "image sizes",
             "largest distance of the principal point of K from the middle of the full picture. A larger one "
             "is refused: camera_info is then of another picture size, and heights would be wrong by a "
             "factor. From half of it on a warning says so. For pictures that are cropped off the middle "
             "(the sky cut away) choose twice their offset");
    v.number("max_baseline", max_baseline, 0.1, 1000.0, "m",
             "longest baseline that is believed. A longer one is refused: the right P[3] is then in "
             "centimetres or millimetres, and heights would be wrong by that factor");
  }
};

}  // namespace uav_landing
