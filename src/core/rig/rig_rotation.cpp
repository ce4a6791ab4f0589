#include "rig/rig_rotation.h"

#include <Eigen/LU>
#include <algorithm>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

double residualOf(const StereoRig& rig, const StereoDepthResult::Point& point, const PlaneVector& plane) {
  return (point.disparity - plane.disparity(rig, point.u, point.v)) / point.disparity_stddev;
}

// Robust size of the residuals, as a multiple of the claimed standard deviations; at least 1.
double residualScale(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                     const PlaneVector& plane) {
  std::vector<double> sizes;
  for (const StereoDepthResult::Point& point : points)
    if (point.on_plane) sizes.push_back(std::abs(residualOf(rig, point, plane)));
  if (sizes.empty()) return 1;
  return std::max(1.0, robustStddev(sizes));
}

}  // namespace

Eigen::RowVector3d disparityByRotation(const StereoRig& rig, double column, double v) {
  const double x = (column - rig.cx_right) / rig.fx, y = (v - rig.cy) / rig.fy;
  return rig.fx * Eigen::RowVector3d(-x * y, 1 + x * x, -y);
}

Eigen::RowVector3d verticalDisparityByRotation(const StereoRig& rig, double column, double v) {
  const double x = (column - rig.cx_right) / rig.fx, y = (v - rig.cy) / rig.fy;
  return rig.fy * Eigen::RowVector3d(1 + y * y, -x * y, -x);
}

Eigen::RowVector2d verticalDisparityByBaseline(const StereoRig& rig, double disparity, double v) {
  const double y = (v - rig.cy) / rig.fy;
  return rig.fy / rig.fx * disparity * Eigen::RowVector2d(-1, y);
}

Eigen::Vector2d placeInRightImage(const StereoRig& rig, const RigRotation& rows, const Eigen::Vector2d& left,
                                  double disparity) {
  const double column = left.x() - disparity - rig.principalOffset();
  if (!rows.known()) return {column, left.y()};
  return {column, left.y() + verticalDisparityByRotation(rig, column, left.y()).dot(rows.w)};
}

Eigen::Vector3d lensVariances(const StereoRig& rig, double row_bias_stddev) {
  const Eigen::Vector3d pixels(row_bias_stddev, 0, row_bias_stddev / kLensReach);
  return (pixels / rig.fy).array().square();
}

Eigen::Matrix3d planeByRotation(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                const PlaneVector& plane) {
  const double scale = residualScale(rig, points, plane);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  for (const StereoDepthResult::Point& point : points) {
    if (!point.on_plane) continue;
    const double root = tukeyRoot(residualOf(rig, point, plane) / (TukeyEnd::kDisparity * scale));
    if (root == 0) continue;
    const double weight = std::pow(root / point.disparity_stddev, 2);
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
