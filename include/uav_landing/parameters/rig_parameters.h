#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "uav_landing/base/failure.h"

namespace uav_landing {

// visit(): see parameters.h.

/// The direction in which the sensor reads the lines of a raw image.
enum class RowDirection { kRows, kColumns };

/// Knowledge about the cameras besides their calibration, for all stages. It has limits for the calibration
/// and how well it is known, how the cameras are mounted, which pixels see the ground, and when their rows
/// are exposed.
struct RigParameters {
  double max_principal_point_offset = 0.2;
  double max_baseline = 50.0;
  double baseline_stddev = 0.0005;
  bool upside_down = false;
  int bits = 0;
  std::string left_mask, right_mask;  ///< file names, see rig_masks.h; empty: none
  /// See row_times.h. NaN: not given. For the right camera this means the same as for the left one.
  double readout_time = std::numeric_limits<double>::quiet_NaN();
  double right_readout_time = std::numeric_limits<double>::quiet_NaN();
  bool estimate_readout_time = false;
  double stamp_row = 0.5;
  double right_stamp_row = std::numeric_limits<double>::quiet_NaN();
  RowDirection row_direction = RowDirection::kRows;

  template <class Visitor>
  void visit(Visitor&& v) {
    v.number("max_principal_point_offset", max_principal_point_offset, 0.05, 5.0, "image sizes",
             "largest distance of the principal point of K from the middle of the full image. A larger one "
             "is refused: camera_info is then of another image size, and heights would be wrong by a "
             "factor. From half of it on a warning says so. For images that are cropped off the middle "
             "(the sky cut away) choose twice their offset");
    v.number("max_baseline", max_baseline, 0.1, 1000.0, "m",
             "longest baseline that is believed. A longer one is refused: the right P[3] is then in "
             "centimetres or millimetres, and heights would be wrong by that factor");
    v.number("baseline_stddev", baseline_stddev, 0.0, 0.1, "of the baseline",
             "1 sigma of the baseline's length, as a share: all heights are wrong by the same share, and no "
             "image shows it. It is in the height's variance and protection level. The default is 0.4 mm on "
             "the 0.8 m of a calibration board; for a baseline that was measured by hand choose more");
    v.flag("upside_down", upside_down,
           "the rig is mounted upside down, and its calibration is of the images as they come. The "
           "images are turned by 180 deg, and left and right are exchanged. Masks, readout times and stamp "
           "rows stay those of the cameras as they are named, and of their images as they come");
    v.number("bits", bits, 0, 16, "bits",
             "used bits of images with 16 bits a pixel, from the lowest one on, 8 or more; 0: the range of "
             "values is found over the first pairs, one for both cameras");
    v.text("left_mask", left_mask,
           "image file with the pixels of the left camera that may be used: nonzero = use, 0 = leave out, as "
           "OpenCV's masks. For what does not move with the ground: the aircraft's nose, a strut, a "
           "propeller. One channel of 8 bit (PNG), as large as the raw images. A relative path begins at "
           "the config file's folder. Empty: the whole image is used");
    v.text("right_mask", right_mask, "the same for the right camera");
    v.number(
        "readout_time", readout_time, -1.0, 1.0, "s",
        "rolling shutter: time from the exposure of the first row of a raw image to that of the last "
        "one, of the image as the driver delivers it. 0: global shutter. Negative: the last row comes "
        "first. Longer than the time between images is refused. Not given: a global shutter, until rows are "
        "seen to move on their own (test row_motion). From then on it is estimated");
    v.flag(
        "estimate_readout_time", estimate_readout_time,
        "estimates readout_time from the first pair on where it is not given, not only from where rows are "
        "seen to move on their own. Angles and heights claim what is not known of it yet, and a pair takes "
        "up to half more time");
    v.number("stamp_row", stamp_row, -2.0, 2.0, "image heights",
             "row that is in the middle of its exposure at the stamp of an image: 0 the first one, 0.5 the "
             "middle one, 1 the last one. Where the stamp is the begin of a row's exposure, subtract half of "
             "the exposure as a share of readout_time; where it is the end, add it");
    v.number("right_readout_time", right_readout_time, -1.0, 1.0, "s",
             "readout_time of the right camera. Not given: the same as for the left one");
    v.number("right_stamp_row", right_stamp_row, -2.0, 2.0, "image heights",
             "stamp_row of the right camera. Not given: the same as for the left one");
    v.choice("row_direction", row_direction, {"rows", "columns"},
             "which lines of a raw image are exposed together: rows, or columns for cameras mounted in "
             "portrait whose driver turns the image. Times are then from left to right");
  }

  /// Refuses what no camera has.
  Failure check() const {
    if (bits == 0 || bits >= 8) return {};
    return {Reason::kInputInvalid, "rig/bits: " + std::to_string(bits) + ", expected 0 or 8 to 16 bits"};
  }
};

}  // namespace uav_landing
