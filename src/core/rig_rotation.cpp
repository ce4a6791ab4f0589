#include "uav_landing/rig_rotation.h"

#include <Eigen/LU>

namespace uav_landing {

Eigen::RowVector3d disparityByRotation(const StereoRig& rig, double column, double v) {
  const double x = (column - rig.cx_right) / rig.fx, y = (v - rig.cy) / rig.fy;
  return rig.fx * Eigen::RowVector3d(-x * y, 1 + x * x, -y);
}

Eigen::RowVector3d verticalDisparityByRotation(const StereoRig& rig, double column, double v) {
  const double x = (column - rig.cx_right) / rig.fx, y = (v - rig.cy) / rig.fy;
  return rig.fy * Eigen::RowVector3d(1 + y * y, -x * y, -x);
}

Eigen::Matrix3d planeByRotation(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  for (const StereoDepthResult::Point& point : points) {
    if (!point.on_plane) continue;
    const double weight = 1 / (point.disparity_stddev * point.disparity_stddev);
    const Eigen::Vector3d by_plane = rig.fb() * rig.ray(point.u, point.v);
    const double column = point.u - point.disparity - rig.principalOffset();
    information += weight * by_plane * by_plane.transpose();
    right += weight * by_plane * disparityByRotation(rig, column, point.v);
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(information);
  if (!lu.isInvertible()) return Eigen::Matrix3d::Zero();
  return lu.solve(right);
}

}  // namespace uav_landing
