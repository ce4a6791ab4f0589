#pragma once

#include <Eigen/Core>
#include <array>

namespace uav_landing {

/// A corner of the image now, with its depth as far as it is known. Fields as in TemporalMatch.
struct TrackedCorner {
  int u = 0, v = 0;
  bool on_plane = true;
  double inverse_depth = 0, inverse_depth_stddev = 0;
};

/// A corner in the image now, and where it was in the image then. Pixels of the rectified left image.
struct TemporalMatch {
  Eigen::Vector2d now, then;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of `then` for a given `now`, pixels^2
  /// Derivatives of `then` by the warp that was used in the search (PatchRefinement::Claim), and that warp.
  std::array<Eigen::Matrix2d, 2> by_warp = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  bool on_plane = true;      ///< depth of the ground plane, else of the corner's own disparity
  double inverse_depth = 0;  ///< of a point off the plane, times the height
  double inverse_depth_stddev = 0;
  /// Side of the square of pixels used for matching. Squares that overlap share their noise.
  double extent = 0;
  /// Derivative by a readout time that is not given, px/s: shift of `then` minus the shift of `now` carried
  /// over to the image then.
  Eigen::Vector2d by_readout = Eigen::Vector2d::Zero();
};

}  // namespace uav_landing
