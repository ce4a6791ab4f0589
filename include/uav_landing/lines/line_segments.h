#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "uav_landing/lines/heading_gate.h"
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

/// A straight edge to about a pixel.
struct RoughSegment {
  Eigen::Vector2d a, b;                                ///< ends, px
  Eigen::Vector2d brighter = Eigen::Vector2d::Zero();  ///< roughly towards the brighter side; 0: not known
};

/// Lines of the ground (paper, section 2): straight edges followed from scan lines, or a Hough transform of
/// the Canny edges (hough_method), each then fitted to the gradient along it. image: rectified mono8. ground:
/// mono8, 255 where lines are looked for (already eroded). gate: only lines that pass it are fitted; the
/// others come after them and stay as they were found, good to half a pixel. Null: all are fitted.
/// Deterministic. Returns an empty list when there are none.
std::vector<LineSegment> findLines(const cv::Mat& image, const cv::Mat& ground,
                                   const ApproachAngleParameters& parameters,
                                   const HeadingGate* gate = nullptr);

/// Those of these lines that are there and pass the gate, fitted to the gradient along them as above.
/// expected: off by up to 2 px; they may reach beyond the image.
std::vector<LineSegment> findLinesNear(const cv::Mat& image, const cv::Mat& ground,
                                       const std::vector<RoughSegment>& expected,
                                       const ApproachAngleParameters& parameters, const HeadingGate& gate);

}  // namespace uav_landing
