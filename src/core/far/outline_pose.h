#pragma once

#include <optional>

#include "far/outline.h"
#include "far/surface_disparity.h"
#include "geometry/ground_normal.h"
#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// The outline as an image shows it.
struct SeenOutline {
  Corners reference;    ///< px
  Vector8d inward;      ///< by how much the sides lie inside of it at its ends, px (see movedInward())
  Matrix8d covariance;  ///< px^2
};

/// Elements of a pose that may be left out.
struct PoseElements {
  bool width = true, length = true;  ///< of the chart
  bool normal = true;                ///< of the ground
  bool stereo = true;                ///< the ground's plane by stereo, which has a scale
};

/// What is known besides the outline. A size that is not known is 0.
struct PoseKnowledge {
  RunwaySize chart;
  double width_stddev = 0.3, length_stddev = 5;  ///< m
  std::optional<GroundNormal> normal;  ///< of the runway's plane, with what it may slope against the ground
  GroundPlane plane;                   ///< of the ground before the threshold
  /// Of the surface itself.
  std::optional<SurfaceDisparity> disparity;
};

/// A pose with the size of the surface.
struct OutlinePose {
  RunwayPose pose;
  RunwaySize size;
  Matrix8d covariance;  ///< of position, roll, pitch, yaw, and the logarithms of width and length
  /// By how much the height grows with the chart's width and length, m for an error as large as the size;
  /// with the disparity, m/px.
  double height_by_width = 0, height_by_length = 0, height_by_disparity = 0;
  double misfit = 0;  ///< sum of the normalised squares of what outline and knowledge differ by
};

/// The pose by the runway's outline, in one least squares of the four sides with what charts, the horizon
/// and stereo say. Four sides are eight numbers, and a pose with a size has eight: so the outline alone
/// leaves the scale open, and says little of roll and pitch from afar. With width and length of the chart the
/// height needs no horizon:
///   D = f W / w,  h = v D (D + L) / (f L)
/// with the near side's width w and the outline's height v in the image. Stereo gives the scale, too: by the
/// disparity of the runway itself, and by the plane before it, on which the threshold lies.
///
/// Fails where nothing tells the scale, or the outline is none of a surface ahead.
Expected<OutlinePose> fitPose(const SeenOutline& seen, const PoseKnowledge& known, const StereoRig& rig,
                              const PoseElements& elements = {});

/// How far the threshold of a pose without stereo lies off the ground's plane, in standard deviations. The
/// ground may rise or fall before the threshold.
double offPlane(const OutlinePose& found, const GroundPlane& plane);

}  // namespace uav_landing
