#include "body_pose.h"

#include <cmath>
#include <sstream>

#include "height/height_limit.h"
#include "pose_covariance.h"

namespace uav_landing {
namespace {

void refuseHeight(const Failure& failure, LandingResult& body) {
  if (!body.height_valid || !failure) return;
  body.height_valid = false;
  body.forgetVelocity();
  if (!body.failure) body.failure = failure;
}

Failure levelAbove(double limit, double level, double by) {
  if (!(level > limit)) return {};
  std::ostringstream text;
  text.precision(4);  // as in the reasons of the stages
  text << "the lever arm adds " << by << " m to the protection level: " << level << " m, alert limit "
       << limit << " m";
  return {Reason::kUncertain, text.str()};
}

}  // namespace

Eigen::Matrix3d runwayFromCamera(const LandingResult& camera) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double yaw = std::isfinite(camera.yaw) ? camera.yaw : 0;
  Eigen::Matrix3d body_from_optical;  // forward = z, left = -x, up = -y
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(-camera.pitch, Vector3d::UnitY()) *
         AngleAxisd(camera.roll, Vector3d::UnitX()) * body_from_optical;
}

// n = (sin roll cos pitch, cos roll cos pitch, -sin pitch), and the height changes by -n.point.
double heightByRoll(const LandingResult& camera, const Eigen::Vector3d& point) {
  return -Eigen::Vector3d(std::cos(camera.roll), -std::sin(camera.roll), 0).dot(point) *
         std::cos(camera.pitch);
}

double heightByPitch(const LandingResult& camera, const Eigen::Vector3d& point) {
  const double sp = std::sin(camera.pitch);
  return Eigen::Vector3d(std::sin(camera.roll) * sp, std::cos(camera.roll) * sp, std::cos(camera.pitch))
      .dot(point);
}

LandingResult referTo(const Eigen::Vector3d& point, const LandingResult& camera, const GroundPlane& plane,
                      const ApproachAngleResult::Motion& step, const KalmanHeightParameters& parameters) {
  LandingResult body = camera;
  const Eigen::Vector3d n = normalFromPitchRoll(camera.pitch, camera.roll);
  if (!n.allFinite()) {
    body.height = body.height_variance = body.raw_height = body.raw_height_variance = kUnknown;
    body.points_height = body.vertical_speed = body.vertical_speed_variance = kUnknown;
    body.height_protection_level = kUnknown;
    body.forgetPosition();
    refuseHeight({Reason::kNoGroundNormal, "the lever arm needs the attitude"}, body);
    return body;
  }
  const double shift = -n.dot(point);
  body.height += shift;
  body.height_variance = heightVariance(camera, camera.height_variance, plane, point);
  body.raw_height += shift;
  body.raw_height_variance = heightVariance(camera, camera.raw_height_variance, plane, point);
  body.points_height += shift;
  body.height_above_runway += shift;
  const double by_attitude = heightVariance(camera, 0, GroundPlane(), point);
  body.height_above_runway_variance += by_attitude;
  const double swing = normalQuantile(parameters.integrity_risk) * std::sqrt(by_attitude);
  body.height_protection_level += swing;
  body.height_above_runway_protection_level += swing;
  if (!(body.height_above_runway_protection_level <= body.height_above_runway_limit))
    body.height_above_runway_known = false;
  refuseHeight(levelAbove(body.height_alert_limit, body.height_protection_level, swing), body);
  refuseHeight(tooUncertain(body.height, body.height_variance, parameters), body);

  const Eigen::Vector3d across = runwayFromCamera(camera) * point;
  body.x += across.x();
  body.y += across.y();
  if (std::isfinite(camera.yaw_variance)) {
    body.x_variance += across.y() * across.y() * camera.yaw_variance;
    body.y_variance += across.x() * across.x() * camera.yaw_variance;
    body.y_protection_level +=
        normalQuantile(parameters.integrity_risk) * std::abs(across.x()) * std::sqrt(camera.yaw_variance);
  }

  const double angle = step.rotation.norm();
  if (!std::isfinite(angle) || !(step.duration > 0)) {
    body.vertical_speed = body.vertical_speed_variance = kUnknown;
    return body;
  }
  // The normal at the previous pair, in that pair's camera frame. The point is at rest in the camera frame.
  const Eigen::AngleAxisd now_from_then(
      angle, angle > 0 ? (step.rotation / angle).eval() : Eigen::Vector3d::UnitX());
  const Eigen::Vector3d n_then = now_from_then.inverse() * n;
  body.vertical_speed -= (n - n_then).dot(point) / step.duration;
  const Eigen::Vector3d by_rotation = n.cross(point) / step.duration;
  body.vertical_speed_variance += by_rotation.dot(step.covariance.topLeftCorner<3, 3>() * by_rotation);
  return body;
}

}  // namespace uav_landing
