#include "height/camera_velocity.h"

namespace uav_landing {

CameraVelocity cameraVelocity(const ApproachAngleResult::Motion& step, double height, double height_variance,
                              double duration_variance) {
  if (step.failure || !(step.duration > 0)) return {};
  const double rate = height / step.duration;
  const Eigen::Vector3d mean = rate * step.translation_over_height;
  const double of_length = height_variance / (height * height) + duration_variance;
  return {mean,
          rate * rate * step.covariance.bottomRightCorner<3, 3>() + of_length * mean * mean.transpose()};
}

}  // namespace uav_landing
