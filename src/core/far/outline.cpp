#include "far/outline.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kNearest = 1;  // m in front of the camera

/// Where two lines meet, each given by a point and its inward normal.
Eigen::Vector2d meeting(const Eigen::Vector2d& a, const Eigen::Vector2d& normal_a, const Eigen::Vector2d& b,
                        const Eigen::Vector2d& normal_b) {
  Eigen::Matrix2d normals;
  normals << normal_a.transpose(), normal_b.transpose();
  return normals.inverse() * Eigen::Vector2d(normal_a.dot(a), normal_b.dot(b));
}

}  // namespace

Eigen::Matrix3d RunwayPose::cameraFromRunway() const {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d body = (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(-pitch, Vector3d::UnitY()) *
                                AngleAxisd(roll, Vector3d::UnitX()))
                                   .toRotationMatrix();
  // The body's axes are forward, left and up; the camera's right, down and forward.
  Eigen::Matrix3d camera;
  camera << -body.col(1).transpose(), -body.col(2).transpose(), body.col(0).transpose();
  return camera;
}

GroundPlane planeOf(const RunwayPose& pose) {
  GroundPlane plane;
  plane.g = -pose.cameraFromRunway().col(2) / pose.position.z();
  return plane;
}

OutlineSide::OutlineSide(const Corners& corners, int side)
    : from(corners[side]), along((corners[(side + 1) % kSides] - from).normalized()) {
  length = (corners[(side + 1) % kSides] - from).norm();
  inward = {-along.y(), along.x()};
}

Eigen::Vector2d OutlineSide::movedTo(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  const double at_a = along.dot(a - from), at_b = along.dot(b - from);
  const double in_a = inward.dot(a - from), slope = (inward.dot(b - from) - in_a) / (at_b - at_a);
  return {in_a - slope * at_a, in_a + slope * (length - at_a)};
}

std::optional<Corners> cornersOf(const RunwayPose& pose, const RunwaySize& size, const StereoRig& rig) {
  const double half = 0.5 * size.width;
  const std::array<Eigen::Vector3d, kSides> points{
      Eigen::Vector3d(0, half, 0), {size.length, half, 0}, {size.length, -half, 0}, {0, -half, 0}};
  Corners corners;
  for (int i = 0; i < kSides; ++i) {
    const Eigen::Vector3d point = pose.seen(points[i]);
    if (!(point.z() >= kNearest)) return std::nullopt;
    corners[i] = rig.project(point);
  }
  return corners;
}

double widthInRow(const Corners& corners, double row) {
  const auto column = [&](const Eigen::Vector2d& near, const Eigen::Vector2d& far) {
    return near.x() + (far.x() - near.x()) * (row - near.y()) / (far.y() - near.y());
  };
  return column(corners[3], corners[2]) - column(corners[0], corners[1]);
}

Eigen::AlignedBox2d boxOf(const Corners& corners) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : corners) box.extend(corner);
  return box;
}

Vector8d movedInward(const Corners& reference, const Corners& corners) {
  Vector8d moved;
  for (int i = 0; i < kSides; ++i)
    moved.segment<2>(2 * i) = OutlineSide(reference, i).movedTo(corners[i], corners[(i + 1) % kSides]);
  return moved;
}

Corners movedBy(const Corners& reference, const Vector8d& inward) {
  std::array<Eigen::Vector2d, kSides> points, normals;
  for (int i = 0; i < kSides; ++i) {
    const OutlineSide side(reference, i);
    const Eigen::Vector2d a = side.from + inward[2 * i] * side.inward;
    const Eigen::Vector2d b = side.from + side.length * side.along + inward[2 * i + 1] * side.inward;
    const Eigen::Vector2d along = (b - a).normalized();
    points[i] = a;
    normals[i] = {-along.y(), along.x()};
  }
  Corners corners;
  for (int i = 0; i < kSides; ++i) {
    const int before = (i + kSides - 1) % kSides;
    corners[i] = meeting(points[before], normals[before], points[i], normals[i]);
  }
  return corners;
}

}  // namespace uav_landing
