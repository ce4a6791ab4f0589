#pragma once

#include "uav_landing/geometry/calibration.h"

namespace uav_landing {
namespace test {

/// A rectified rig from its numbers: pixels, and metres for the baseline.
inline StereoRig rigOf(cv::Size size, double focal_length, cv::Point2d centre, double cx_right,
                       double baseline) {
  StereoRig rig;
  rig.size = size;
  rig.fx = rig.fy = focal_length;
  rig.cx = centre.x;
  rig.cy = centre.y;
  rig.cx_right = cx_right;
  rig.baseline = baseline;
  return rig;
}

}  // namespace test
}  // namespace uav_landing
