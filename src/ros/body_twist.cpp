#include "body_twist.h"

#include <cmath>

#include "geometry/cross_matrix.h"

namespace uav_landing {

std::optional<BodyTwist> bodyTwist(const LandingResult& camera, double duration, double acceleration_stddev,
                                   const Eigen::Isometry3d& camera_from_child) {
  if (!camera.velocity.allFinite() || !camera.angular_velocity.allFinite() ||
      !camera.twist_covariance.allFinite() || !std::isfinite(duration))
    return std::nullopt;
  Matrix6d of_camera = camera.twist_covariance;
  // The mean velocity is that of the middle of the step.
  of_camera.diagonal().head<3>().array() += std::pow(0.5 * duration * acceleration_stddev, 2);
  const Eigen::Matrix3d turn = camera_from_child.linear().transpose();
  const Eigen::Vector3d arm = camera_from_child.translation();
  Matrix6d by_camera = Matrix6d::Zero();
  by_camera.topLeftCorner<3, 3>() = by_camera.bottomRightCorner<3, 3>() = turn;
  by_camera.topRightCorner<3, 3>() = -turn * crossMatrix(arm);
  return BodyTwist{turn * (camera.velocity + camera.angular_velocity.cross(arm)),
                   turn * camera.angular_velocity, by_camera * of_camera * by_camera.transpose()};
}

}  // namespace uav_landing
