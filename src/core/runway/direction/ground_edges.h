#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segments.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Axes of the ground in the left camera frame, with their uncertainty. Lengths on the ground are in
/// multiples of the left camera's height.
struct GroundAxes {
  /// Nearest that a point may come to the horizon, as n.r with the ray r. Closer to it nothing is measured.
  static constexpr double kLeastSlope = 1e-3;

  Eigen::Vector3d down;     ///< ground normal n, unit, left camera frame
  Eigen::Vector3d forward;  ///< landing direction within the ground, unit
  Eigen::Vector3d left;     ///< perpendicular to both, unit
  /// Covariance of small rotations of the axes about forward, left and down, rad^2.
  Eigen::Matrix3d covariance;

  /// direction: vanishing direction of the runway. Only its part within the ground is used. The covariances
  /// belong to the normal and to the direction, rad^2.
  GroundAxes(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
             const Eigen::Vector3d& direction, const Eigen::Matrix3d& direction_covariance);

  /// Point where a ray from a camera meets the ground: forward and left of the point below that camera, in
  /// multiples of its height. ray: of any length, pointing below the horizon.
  Eigen::Vector2d meet(const Eigen::Vector3d& ray) const;
  /// Derivatives of meet() by rotations of the axes (see covariance). Rows: forward, left.
  static Eigen::Matrix<double, 2, 3> meetByRotation(const Eigen::Vector2d& point);
};

/// A straight piece of an edge on the ground as seen in one view. It has its lateral position in the middle,
/// and its slope against the landing direction. Units are multiples of the left camera's height, measured
/// forward and left from that camera.
struct EdgePiece {
  double forward = 0, lateral = 0, slope = 0;  ///< slope: leftwards per unit forward
  Eigen::Matrix2d covariance;                  ///< of (lateral, slope), from the image alone
};

/// An edge on the ground along the runway. Its lateral position is the same over its whole length.
struct GroundEdge {
  double lateral = 0;   ///< left of the left camera, in multiples of its height
  double variance = 0;  ///< from the image alone
  /// Derivatives of lateral by rotations of the axes, which are common to all edges.
  Eigen::Vector3d by_rotation;
  bool brighter_left = false;  ///< whether it is brighter on its left side than on its right
  double near = 0, far = 0;    ///< ends, forward of the camera in multiples of its height
  double pixel = 0;            ///< angle of one pixel, rad; 0 when blur moves nothing
  bool begins = false;         ///< whether the near end lies within the image and not at its border
  double extent = 0;           ///< sum of log(far / near) of its pieces
  std::vector<EdgePiece> pieces;
};

/// Where the camera of a view stands, in the axes of the left camera.
struct ViewCamera {
  double cx;            ///< principal column
  double baseline = 0;  ///< distance to the right of the left camera, in multiples of its height
};

/// Tells which lines of one view may run along the runway, given their own uncertainty and that of the axes:
/// 1 for each of these. cx: principal column of the view.
std::vector<char> linesAlong(const StereoRig& rig, const GroundAxes& axes,
                             const std::vector<LineSegment>& lines, double cx);

/// Joins the lines of one view that run along the runway to edges, the longest one first. along: 1 for each
/// line along the runway.
std::vector<GroundEdge> groundEdges(const StereoRig& rig, const GroundAxes& axes,
                                    const std::vector<LineSegment>& lines, const std::vector<char>& along,
                                    const ViewCamera& camera);

/// Edges that both views see at the same place on the ground, such as paint or the edge of the pavement. An
/// object above the ground appears at two places, so it is rejected. The same holds for lines that do not
/// belong to one edge.
std::vector<GroundEdge> matchEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                   const std::vector<GroundEdge>& right);

/// Edges seen by at least one view: the matched ones, and the other ones of each view.
std::vector<GroundEdge> joinEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                  const std::vector<GroundEdge>& right);

}  // namespace uav_landing
