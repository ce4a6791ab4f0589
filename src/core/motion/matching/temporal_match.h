#pragma once

#include <Eigen/Core>
#include <array>

namespace uav_landing {

/// A corner of the image now with what is known of its depth (see TemporalMatch).
struct TrackedCorner {
  int u = 0, v = 0;
  bool on_plane = true;
  double inverse_depth = 0, inverse_depth_stddev = 0;
};

/// A corner now and where it was then. Pixels of the rectified left image.
struct TemporalMatch {
  Eigen::Vector2d now, then;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of then given now, pixels^2
  /// How then follows from the warp it was looked for with, and that warp (PatchRefinement::Claim).
  std::array<Eigen::Matrix2d, 2> by_warp = {Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
  bool on_plane = true;      ///< depth from the ground plane, else from its own disparity
  double inverse_depth = 0;  ///< of a point off the plane, times height
  double inverse_depth_stddev = 0;
  /// Side of the square of pixels that it was matched by; those that overlap share noise.
  double extent = 0;
  /// How then, less where now is seen then, follows a readout time that is not given, px/s.
  Eigen::Vector2d by_readout = Eigen::Vector2d::Zero();
};

}  // namespace uav_landing
