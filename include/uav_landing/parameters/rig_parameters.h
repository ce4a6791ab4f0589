#pragma once

#include <string>

#include "uav_landing/base/failure.h"

namespace uav_landing {

// visit(): see parameters.h.

/// What is known of the cameras besides their calibration, for all stages: limits of what is believed of
/// that, how well it is known, how the cameras are mounted, and which pixels see the ground.
struct RigParameters {
  double max_principal_point_offset = 0.2;
  double max_baseline = 50.0;
  double baseline_stddev = 0.0005;
  bool upside_down = false;
  int bits = 0;
  std::string left_mask, right_mask;  ///< files, see rig_masks.h; empty: none

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
    v.number("baseline_stddev", baseline_stddev, 0.0, 0.1, "of the baseline",
             "1 sigma of the baseline's length, as a share: all heights are wrong by the same share, and no "
             "image shows it. It is in the height's variance and protection level. The default is 0.4 mm on "
             "the 0.8 m of a calibration board; for a baseline that was measured by hand choose more");
    v.flag("upside_down", upside_down,
           "the rig is mounted upside down, and its calibration is of the pictures as they come. The "
           "pictures are turned by 180 deg, and left and right are exchanged");
    v.number("bits", bits, 0, 16, "bits",
             "used bits of images with 16 bits a pixel, from the lowest one on, 8 or more; 0: the range of "
             "values is found over the first pairs, one for both cameras");
    v.text("left_mask", left_mask,
           "image file with the pixels of the left camera that may be used: nonzero = use, 0 = leave out, as "
           "OpenCV's masks. For what does not move with the ground: the aircraft's nose, a strut, a "
           "propeller. One channel of 8 bit (PNG), as large as the raw pictures. A relative path begins at "
           "the config file's folder. Empty: the whole picture is used");
    v.text("right_mask", right_mask, "the same for the right camera");
  }

  /// What no camera has.
  Failure check() const {
    if (bits == 0 || bits >= 8) return {};
    return {Reason::kInputInvalid, "rig/bits: " + std::to_string(bits) + ", expected 0 or 8 to 16 bits"};
  }
};

}  // namespace uav_landing
