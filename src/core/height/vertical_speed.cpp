#include "height/vertical_speed.h"

#include <cmath>

namespace uav_landing {

VerticalSpeed verticalSpeed(const ApproachAngleResult::Motion& step, const GroundPlane& plane, double height,
                            const VerticalSpeedErrors& errors) {
  if (step.failure || !(step.duration > 0)) return {};
  const Eigen::Vector3d n = plane.normal();
  const Eigen::Vector3d& t = step.translation_over_height;
  const Eigen::Matrix3d t_covariance = step.covariance.bottomRightCorner<3, 3>();
  const double rate = height / step.duration;
  const double descent = n.dot(t);
  const double half_step = 0.5 * step.duration * errors.acceleration;

  VerticalSpeed result;
  result.speed = -descent * rate;
  result.variance = rate * rate * (n.dot(t_covariance * n) + t.dot(plane.normalCovariance() * t)) +
                    rate * rate * errors.slope * errors.slope * t.squaredNorm() +
                    std::pow(descent / step.duration, 2) * errors.height_variance + half_step * half_step;
  return result;
}

VerticalSpeed withDurations(VerticalSpeed speed, double duration_variance) {
  speed.variance += speed.speed * speed.speed * duration_variance;
  return speed;
}

}  // namespace uav_landing
