#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// A straight edge, refined to sub-pixel. Pixels of the rectified image.
struct LineSegment {
  Eigen::Vector2d a, b;  ///< end points
  Eigen::Vector3d line;  ///< homogeneous, (l0, l1) of unit length: l.[u v 1] is the distance in pixels
  double offset_stddev;  ///< of the distance at the segment's middle, pixels
  double angle_stddev;   ///< of the direction, rad

  double length() const { return (b - a).norm(); }
  Eigen::Vector2d middle() const { return 0.5 * (a + b); }
};

/// Lines of the ground (paper, section 2): straight edges followed from scan lines, or a Hough transform of
/// the Canny edges (hough_method), each then fitted to the gradient along it. image: rectified mono8. ground:
/// mono8, 255 where lines are looked for (already eroded). Deterministic. Returns an empty list when there
/// are none.
std::vector<LineSegment> findLines(const cv::Mat& image, const cv::Mat& ground,
                                   const ApproachAngleParameters& parameters);

}  // namespace uav_landing
