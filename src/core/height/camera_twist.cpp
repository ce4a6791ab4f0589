#include "height/camera_twist.h"

namespace uav_landing {

CameraTwist cameraTwist(const ApproachAngleResult::Motion& step, double height, double height_variance,
                        double duration_variance) {
  if (step.failure || !(step.duration > 0)) return {};
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const double rate = height / step.duration;
  Vector6d twist;
  twist << rate * step.translation_over_height, -step.rotation / step.duration;
  Matrix6d by_step = Matrix6d::Zero();
  by_step.topRightCorner<3, 3>() = rate * Eigen::Matrix3d::Identity();
  by_step.bottomLeftCorner<3, 3>() = -1 / step.duration * Eigen::Matrix3d::Identity();
  // All lengths share the error of the height, and all values that of the duration.
  Vector6d lengths = twist;
  lengths.tail<3>().setZero();
  const Matrix6d covariance = by_step * step.covariance * by_step.transpose() +
                              height_variance / (height * height) * lengths * lengths.transpose() +
                              duration_variance * twist * twist.transpose();
  return {twist.head<3>(), twist.tail<3>(), covariance};
}

}  // namespace uav_landing
