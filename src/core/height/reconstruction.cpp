#include "height/reconstruction.h"

#include <cmath>

namespace uav_landing {

double depthFromDisparity(const StereoRig& rig, double disparity) { return rig.fb() / disparity; }

Eigen::Vector3d rotateToWorld(const Eigen::Vector3d& paper_point, double theta) {
  Eigen::Matrix3d rotation;
  rotation << 1, 0, 0, 0, std::cos(theta), -std::sin(theta), 0, std::sin(theta), std::cos(theta);
  return rotation * paper_point;
}

double heightOverPoint(double y_c, double z_c, double theta) {
  return rotateToWorld({0, y_c, z_c}, theta).z();
}

AveragedHeight averageHeight(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                             double theta, double roll, bool only_on_plane) {
  // Eq (5) is linear, so the points need only the heights of the camera's unit vectors.
  const Eigen::Vector3d of_axes(heightOverPoint(0, std::sin(roll), theta),
                                heightOverPoint(0, std::cos(roll), theta), heightOverPoint(1, 0, theta));
  // Welford's recursion stays accurate when the scatter is small against the height.
  double mean = 0, squares = 0;
  AveragedHeight averaged;
  for (const StereoDepthResult::Point& point : points) {
    if (!(point.disparity > 0) || (only_on_plane && !point.on_plane)) continue;
    const double height = depthFromDisparity(rig, point.disparity) * of_axes.dot(rig.ray(point.u, point.v));
    const double deviation = height - mean;
    mean += deviation / ++averaged.points;
    squares += deviation * (height - mean);
  }
  const int n = averaged.points;
  if (n > 0) averaged.height = mean;
  if (n > 1) averaged.variance = squares / (n - 1) / n;
  return averaged;
}

}  // namespace uav_landing
