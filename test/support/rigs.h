#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/results/stage_results.h"

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

/// 640 x 480, f = 500 px, baseline 1 m.
inline StereoRig usualRig() { return rigOf({640, 480}, 500, {320, 240}, 320, 1.0); }

/// The rotation of a rig whose rows match exactly.
inline RigRotation levelRows() { return {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()}; }

}  // namespace test
}  // namespace uav_landing
