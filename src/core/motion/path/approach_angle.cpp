#include "motion/path/approach_angle.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

double approachAngle(const Eigen::Vector3d& normal, const Eigen::Vector3d& translation) {
  return std::asin(std::clamp(normal.dot(translation) / translation.norm(), -1.0, 1.0));
}

double approachAngleVariance(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                             const Eigen::Vector3d& translation,
                             const Eigen::Matrix3d& translation_covariance) {
  // sin(theta) = n.m with m = t / |t|, so d theta = (m.dn + n.dm) / cos(theta), dm = (I - m m') dt / |t|.
  const double length = translation.norm();
  const Eigen::Vector3d m = translation / length;
  const Eigen::Vector3d across = (normal - normal.dot(m) * m) / length;
  const double cos2 = 1 - std::pow(normal.dot(m), 2);
  return (m.dot(normal_covariance * m) + across.dot(translation_covariance * across)) / cos2;
}

double approachAngleEq1(double H, double L, double f) { return std::atan(H / f) - std::atan(L / f); }

}  // namespace uav_landing
