#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segments.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The ground's axes as the left camera sees them, and how well they are known. Lengths on the ground are in
/// multiples of the left camera's height above it.
struct GroundAxes {
  /// n.r of the horizon's neighbourhood, where nothing is measured.
  static constexpr double kLeastSlope = 1e-3;

  Eigen::Vector3d down;     ///< ground normal n, unit, left camera frame
  Eigen::Vector3d forward;  ///< landing direction in the ground, unit
  Eigen::Vector3d left;     ///< across it, unit
  /// Variances and covariances of small rotations of the axes about forward, left and down. rad^2.
  Eigen::Matrix3d covariance;

  /// direction: vanishing point of the runway, its part along the normal is left out. direction_covariance:
  /// of the direction, normal_covariance: of the normal, both rad^2.
  GroundAxes(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
             const Eigen::Vector3d& direction, const Eigen::Matrix3d& direction_covariance);

  /// Where a ray from a camera meets the ground, in multiples of that camera's height: forward and left of
  /// the point below it. ray: any length; must point below the horizon.
  Eigen::Vector2d meet(const Eigen::Vector3d& ray) const;
  /// Derivatives of meet() by the rotations that covariance is of. One row for forward, one for left.
  static Eigen::Matrix<double, 2, 3> meetByRotation(const Eigen::Vector2d& point);
};

/// A straight piece of an edge on the ground, as one view sees it: lateral position at its middle and slope
/// against the landing direction. Multiples of the left camera's height, forward and left of that camera.
struct EdgePiece {
  double forward = 0, lateral = 0, slope = 0;  ///< slope: to the left per forward
  Eigen::Matrix2d covariance;                  ///< of (lateral, slope) in the image alone
};

/// An edge on the ground along the runway: all of it has the same lateral position.
struct GroundEdge {
  double lateral = 0;           ///< left of the left camera, in multiples of its height
  double variance = 0;          ///< of the edge in the image alone
  Eigen::Vector3d by_rotation;  ///< derivatives by the rotations of the axes: common to all edges
  bool brighter_left = false;   ///< which side is
  double near = 0, far = 0;     ///< from where to where it is seen, forward of the camera
  double pixel = 0;             ///< angle of one, rad; 0 where blur moves nothing
  bool begins = false;          ///< within the picture: the near end is not where the picture ends
  double extent = 0;            ///< sum of log(far / near) of its pieces
  std::vector<EdgePiece> pieces;
};

/// Which lines of one view run along the runway, as far as they and the axes can tell: 1 for those. cx:
/// principal column of the view.
std::vector<char> linesAlong(const StereoRig& rig, const GroundAxes& axes,
                             const std::vector<LineSegment>& lines, double cx);

/// The lines of one view that lie along the runway, pieces of one edge joined. lines: of that view, with
/// along: 1 for those along the runway. cx: principal column of the view. baseline: of the view's
/// camera to the right of the left one, in multiples of the height; 0 for the left view. Longest first.
std::vector<GroundEdge> groundEdges(const StereoRig& rig, const GroundAxes& axes,
                                    const std::vector<LineSegment>& lines, const std::vector<char>& along,
                                    double cx, double baseline);

/// Edges that both views see at the same place on the ground: paint on it, or its own edge. What stands above
/// the ground, or is not one and the same thing, is seen at two places and left out.
std::vector<GroundEdge> matchEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                   const std::vector<GroundEdge>& right);

/// Edges seen by at least one view: the matched ones, and each view's other ones.
std::vector<GroundEdge> joinEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                  const std::vector<GroundEdge>& right);

}  // namespace uav_landing
