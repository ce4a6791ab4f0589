#include "body_twist.h"

#include "cross_matrix.h"

namespace uav_landing {

std::optional<BodyTwist> bodyTwist(const LandingResult& camera, const ApproachAngleResult::Motion& step,
                                   const Eigen::Isometry3d& camera_from_child) {
  const double T = step.duration;
  if (!camera.velocity.allFinite() || !camera.velocity_covariance.allFinite() || !(T > 0) ||
      !step.rotation.allFinite() || !step.covariance.allFinite())
    return std::nullopt;
  // The step's rotation is that of the ground as the camera sees it.
  const Eigen::Vector3d angular = -step.rotation / T;
  const Eigen::Vector3d& t = step.translation_over_height;
  const double per_height = t.squaredNorm() > 0 ? camera.velocity.dot(t) / t.squaredNorm() : 0;
  Matrix6d of_camera;
  of_camera.topLeftCorner<3, 3>() = camera.velocity_covariance;
  of_camera.bottomRightCorner<3, 3>() = step.covariance.topLeftCorner<3, 3>() / (T * T);
  of_camera.topRightCorner<3, 3>() = -per_height / T * step.covariance.bottomLeftCorner<3, 3>();
  of_camera.bottomLeftCorner<3, 3>() = of_camera.topRightCorner<3, 3>().transpose();

  const Eigen::Matrix3d turn = camera_from_child.linear().transpose();
  const Eigen::Vector3d arm = camera_from_child.translation();
  Matrix6d by_camera = Matrix6d::Zero();
  by_camera.topLeftCorner<3, 3>() = by_camera.bottomRightCorner<3, 3>() = turn;
  by_camera.topRightCorner<3, 3>() = -turn * crossMatrix(arm);
  return BodyTwist{turn * (camera.velocity + angular.cross(arm)), turn * angular,
                   by_camera * of_camera * by_camera.transpose()};
}

}  // namespace uav_landing
