#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "geometry/stamp_map.h"
#include "support/ground_renderer.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/geometry/row_turns.h"

namespace uav_landing {
namespace test {

/// A camera that glides, pitches, rolls and yaws steadily: at rest in the picture nothing is.
inline Pose movingPose(double t) {
  Pose pose;
  pose.position = {4.0 * t, 0.1 * t, 1.6 - 0.5 * t};
  pose.pitch = (-8 + 9 * t) * kDegree;
  pose.roll = (1 - 12 * t) * kDegree;
  pose.yaw = (0.5 + 7 * t) * kDegree;
  return pose;
}

/// The motion at a time by the difference of poses around it; its acceleration is left at 0. poseAt: of a
/// time.
template <class PoseAt>
RowMotion motionAt(double t, const PoseAt& poseAt) {
  constexpr double kHalf = 1e-4;
  const Pose before = poseAt(t - kHalf), behind = poseAt(t + kHalf), now = poseAt(t);
  const Movement movement(before, behind);
  const Eigen::AngleAxisd turn(movement.R);
  return {turn.angle() * turn.axis() / (2 * kHalf),
          now.seen(behind.position - before.position) / (2 * kHalf) / now.height()};
}

/// Of the camera that moves steadily.
inline RowMotion motionAt(double t) { return motionAt(t, movingPose); }

/// What a gyroscope on the camera says of the rows of an image. bias: of its rates, rad/s.
template <class PoseAt>
std::shared_ptr<const RowTurns> gyroRows(double stamp, const PoseAt& poseAt,
                                         const Eigen::Vector3d& bias = Eigen::Vector3d::Zero()) {
  constexpr int kEachSide = 20;
  std::vector<Eigen::Vector3d> rates;
  for (int i = -kEachSide; i <= kEachSide; ++i)
    rates.push_back(motionAt(stamp + i * RowTurns::kInterval, poseAt).w - bias);
  return std::make_shared<const RowTurns>(-kEachSide * RowTurns::kInterval, rates,
                                          1e-8 * Eigen::Matrix3d::Identity());
}

/// The calibration of a rectified camera without lens errors.
inline CameraCalibration calibrationOf(const StereoRig& rig, bool right = false) {
  CameraCalibration c;
  c.width = rig.size.width;
  c.height = rig.size.height;
  c.distortion_model = "plumb_bob";
  c.K = rig.K();
  c.R = Eigen::Matrix3d::Identity();
  if (right) c.K(0, 2) = rig.cx_right;
  c.P.leftCols<3>() = c.K;
  c.P(0, 3) = right ? -rig.fb() : 0;
  return c;
}

/// Where a rolling shutter whose middle row has the stamp sees a point of the world: in the row that has the
/// time at which it is there. poseAt: of a time.
template <class PoseAt>
Eigen::Vector2d rollingPixel(const PoseAt& poseAt, const StereoRig& rig, double stamp, double readout,
                             const Eigen::Vector3d& world) {
  constexpr int kSteps = 50;
  Eigen::Vector2d pixel(0, 0.5 * rig.size.height);
  for (int i = 0; i < kSteps; ++i) {
    const Pose pose = poseAt(stamp + ((pixel.y() + 0.5) / rig.size.height - 0.5) * readout);
    pixel = rig.project(pose.seen(world - pose.position));
  }
  return pixel;
}

/// What a rolling shutter sees whose middle row has the stamp: each row from where the camera is then.
/// poseAt: of a time.
template <class PoseAt>
cv::Mat rollingImage(const PoseAt& poseAt, const GroundRenderer& ground, const StereoRig& rig, double stamp,
                     double readout, bool right = false) {
  cv::Mat image(rig.size, CV_8UC1);
  StereoRig row = rig;
  row.size.height = 1;
  for (int v = 0; v < rig.size.height; ++v) {
    const Pose pose = poseAt(stamp + ((v + 0.5) / rig.size.height - 0.5) * readout);
    row.cy = rig.cy - v;
    const Exposure noiseless{1, 0, 0};
    (right ? ground.right(row, pose, noiseless) : ground.left(row, pose, noiseless)).copyTo(image.row(v));
  }
  return image;
}
/// Of the camera that moves steadily.
inline cv::Mat rollingImage(const GroundRenderer& ground, const StereoRig& rig, double stamp, double readout,
                            bool right = false) {
  return rollingImage(movingPose, ground, rig, stamp, readout, right);
}

}  // namespace test
}  // namespace uav_landing
