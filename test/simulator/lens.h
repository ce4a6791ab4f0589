#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

// Geometry for the simulator's tests, written down anew from the definitions: nothing here uses the
// simulator.

constexpr double kDegree = M_PI / 180;

/// Kannala and Brandt's model of fisheye lenses.
inline Eigen::Vector2d throughFisheye(const SimulatedCameraParameters& camera, const Eigen::Vector3d& point) {
  const double across = std::hypot(point.x(), point.y()), angle = std::atan2(across, point.z());
  const double distance = angle + camera.k1 * std::pow(angle, 3) + camera.k2 * std::pow(angle, 5) +
                          camera.k3 * std::pow(angle, 7) + camera.k4 * std::pow(angle, 9);
  return {camera.fx * distance * point.x() / across + camera.cx,
          camera.fy * distance * point.y() / across + camera.cy};
}

/// The plumb_bob model: pixel of a point in the camera's own axes.
inline Eigen::Vector2d throughLens(const SimulatedCameraParameters& camera, const Eigen::Vector3d& point) {
  if (camera.lens == SimulatedLens::kEquidistant) return throughFisheye(camera, point);
  const double x = point.x() / point.z(), y = point.y() / point.z(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double xd = x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x);
  const double yd = y * radial + camera.p1 * (r2 + 2 * y * y) + 2 * camera.p2 * x * y;
  return {camera.fx * xd + camera.cx, camera.fy * yd + camera.cy};
}

/// A point in the left raw camera's axes, expressed in the right raw camera's.
inline Eigen::Vector3d leftToRight(const SimulatedRigParameters& rig, const Eigen::Vector3d& point) {
  const Eigen::Vector3d vector = kDegree * Eigen::Vector3d(rig.rx_deg, rig.ry_deg, rig.rz_deg);
  const Eigen::Matrix3d axes = vector.norm() > 0
                                   ? Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix()
                                   : Eigen::Matrix3d::Identity();
  return axes.transpose() * (point - Eigen::Vector3d(rig.x, rig.y, rig.z));
}

/// A camera's optical axes in the runway frame, from what the angles mean: the optical axis is yawed to the
/// left of the landing direction and raised by the pitch; roll lowers the right side. Columns: right, down,
/// forward.
inline Eigen::Matrix3d axesOf(double roll, double pitch, double yaw) {
  const Eigen::Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                                std::sin(pitch));
  const Eigen::Vector3d level_right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d level_down = forward.cross(level_right);
  Eigen::Matrix3d axes;
  axes.col(0) = std::cos(roll) * level_right + std::sin(roll) * level_down;
  axes.col(1) = std::cos(roll) * level_down - std::sin(roll) * level_right;
  axes.col(2) = forward;
  return axes;
}

/// Raw pixel of a point of the runway frame, worked out from lens, rig and attitude alone. R_left: rotation
/// from raw to rectified axes of the left camera, by which the pose is defined.
inline Eigen::Vector2d imageOf(const SimulatorParameters& p, const CameraPose& pose,
                               const Eigen::Matrix3d& R_left, bool right, const Eigen::Vector3d& point) {
  const Attitude& a = pose.attitude;
  const Eigen::Vector3d rectified = axesOf(a.roll, a.pitch, a.yaw).transpose() * (point - pose.position);
  const Eigen::Vector3d raw = R_left.transpose() * rectified;
  return right ? throughLens(p.right_camera, leftToRight(p.rig, raw)) : throughLens(p.left_camera, raw);
}

/// A rig with everything a real one has: different lenses, axes that are not parallel, centres out of line.
inline void makeRealistic(SimulatedCameraParameters& left, SimulatedCameraParameters& right,
                          SimulatedRigParameters& rig) {
  left.fx = 382, left.fy = 380, left.cx = 162, left.cy = 118;
  left.k1 = -0.18, left.k2 = 0.06, left.p1 = 0.0006, left.p2 = -0.0004, left.k3 = 0.01;
  right.fx = 379, right.fy = 378, right.cx = 158, right.cy = 121;
  right.k1 = -0.17, right.k2 = 0.05, right.p1 = -0.0003, right.p2 = 0.0005, right.k3 = 0;
  rig.x = 0.65, rig.y = 0.004, rig.z = -0.006;
  rig.rx_deg = 0.35, rig.ry_deg = -0.6, rig.rz_deg = 0.25;
}

}  // namespace uav_landing
