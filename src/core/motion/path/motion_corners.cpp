#include "motion/path/motion_corners.h"

#include "geometry/half_plane.h"

namespace uav_landing {

std::vector<TrackedCorner> stereoCorners(const StereoRig& rig, const StereoDepthResult& stereo) {
  constexpr double kSmallestDisparity = 1.0;
  const double height = stereo.plane.height();
  std::vector<TrackedCorner> corners;
  for (const StereoDepthResult::Point& point : stereo.points) {
    if (!point.on_plane && point.disparity < kSmallestDisparity) continue;
    corners.push_back({cvRound(point.u), cvRound(point.v), point.on_plane,
                       height * point.disparity / rig.fb(), height * point.disparity_stddev / rig.fb()});
  }
  return corners;
}

std::vector<TrackedCorner> groundCorners(const StereoRig& rig, const RectifiedView& view,
                                         const Eigen::Vector3d& normal,
                                         const ApproachAngleParameters& parameters, CornerMemory& memory) {
  // The ground closer to the horizon than this (tangent of the angle) hardly moves.
  constexpr double kLeastSlope = 0.01;
  // Almost any texture is accepted, because matching decides later. Corners are spread over the ground as for
  // stereo.
  constexpr double kQuality = 1e-7, kDistance = 4.0, kHarris = 0.04;
  const Eigen::Vector3d slope = rig.Kinv().transpose() * normal;  // n.r as a function of the pixel
  cv::Mat ground;
  keepHalfPlane(view.mask, slope.x(), slope.y(), slope.z() - kLeastSlope, ground);
  const int count = cornerBudget(view.image.size(), parameters.corner_count, parameters.pixels_per_corner);
  std::vector<TrackedCorner> corners;
  for (const cv::Point& point :
       findCorners(view.image, ground, {count, kQuality, kDistance, kHarris}, memory))
    corners.push_back({point.x, point.y, true, 0, 0});
  return corners;
}

}  // namespace uav_landing
