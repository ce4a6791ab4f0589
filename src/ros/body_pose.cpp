#include "body_pose.h"

#include <cmath>

namespace uav_landing {

Eigen::Matrix3d runwayFromCamera(const LandingResult& camera) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double yaw = std::isfinite(camera.yaw) ? camera.yaw : 0;
  Eigen::Matrix3d body_from_optical;  // forward = z, left = -x, up = -y
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(-camera.pitch, Vector3d::UnitY()) *
         AngleAxisd(camera.roll, Vector3d::UnitX()) * body_from_optical;
}

LandingResult referTo(const Eigen::Vector3d& point, const LandingResult& camera,
                      const ApproachAngleResult::Motion& step) {
  LandingResult body = camera;
  const Eigen::Vector3d n = normalFromPitchRoll(camera.pitch, camera.roll);
  if (!n.allFinite()) {
    body.height = body.height_variance = body.raw_height = body.raw_height_variance = kUnknown;
    body.points_height = body.vertical_speed = body.vertical_speed_variance = kUnknown;
    body.x = body.x_variance = body.y = body.y_variance = kUnknown;
    if (body.height_valid && !body.failure)
      body.failure = {Reason::kNoGroundNormal, "the lever arm needs the attitude"};
    body.height_valid = false;
    return body;
  }
  // n = (sin roll cos pitch, cos roll cos pitch, -sin pitch) and its derivatives.
  const double sp = std::sin(camera.pitch), cp = std::cos(camera.pitch);
  const double sr = std::sin(camera.roll), cr = std::cos(camera.roll);
  const double by_pitch = Eigen::Vector3d(-sr * sp, -cr * sp, -cp).dot(point);
  const double by_roll = Eigen::Vector3d(cr * cp, -sr * cp, 0).dot(point);
  const double shift = -n.dot(point);
  const double variance =
      by_pitch * by_pitch * camera.pitch_variance + by_roll * by_roll * camera.roll_variance;
  body.height += shift;
  body.height_variance += variance;
  body.raw_height += shift;
  body.raw_height_variance += variance;
  body.points_height += shift;

  const Eigen::Vector3d across = runwayFromCamera(camera) * point;
  body.x += across.x();
  body.y += across.y();
  if (std::isfinite(camera.yaw_variance)) {
    body.x_variance += across.y() * across.y() * camera.yaw_variance;
    body.y_variance += across.x() * across.x() * camera.yaw_variance;
  }

  const double angle = step.rotation.norm();
  if (!std::isfinite(angle) || !(step.duration > 0)) {
    body.vertical_speed = body.vertical_speed_variance = kUnknown;
    return body;
  }
  // The normal of the frame before, as that frame's camera saw it; the point is at rest in the camera frame.
  const Eigen::AngleAxisd now_from_then(
      angle, angle > 0 ? (step.rotation / angle).eval() : Eigen::Vector3d::UnitX());
  const Eigen::Vector3d n_then = now_from_then.inverse() * n;
  body.vertical_speed -= (n - n_then).dot(point) / step.duration;
  const Eigen::Vector3d by_rotation = n.cross(point) / step.duration;
  body.vertical_speed_variance += by_rotation.dot(step.covariance.topLeftCorner<3, 3>() * by_rotation);
  return body;
}

}  // namespace uav_landing
