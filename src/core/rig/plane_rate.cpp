#include "rig/plane_rate.h"

#include "uav_landing/geometry/cross_matrix.h"

namespace uav_landing {
namespace {

bool hasRowTimes(const StereoDepthResult& stereo) {
  return !stereo.plane_by_rate.isZero(0) && stereo.plane.valid();
}

void addVariance(const Eigen::Matrix3d& of_rate, StereoDepthResult& stereo) {
  const Eigen::Matrix3d added = stereo.plane_by_rate * of_rate * stereo.plane_by_rate.transpose();
  stereo.plane.covariance += added;
  if (stereo.below.valid()) stereo.below.covariance += added;
}

}  // namespace

void carryPlane(const RowMotion& motion, StereoDepthResult& stereo) {
  if (!hasRowTimes(stereo)) return;
  const Eigen::Vector3d rate = planeRate(stereo.plane.g, motion);
  const Eigen::Vector3d change = stereo.plane_by_rate * (rate - stereo.plane_rate);
  stereo.plane.g += change;
  if (stereo.below.valid()) stereo.below.g += change;
  stereo.plane_rate = rate;
}

void carryPlane(const ApproachAngleResult::Motion& step, StereoDepthResult& stereo) {
  if (!hasRowTimes(stereo)) return;
  const bool known = step.duration > 0 && step.rotation.allFinite() &&
                     step.translation_over_height.allFinite() && step.covariance.allFinite();
  if (!known) return addVariance(stereo.plane_rate * stereo.plane_rate.transpose(), stereo);
  const Eigen::Vector3d g = stereo.plane.g;
  carryPlane(RowMotion{step.rotation / step.duration, step.translation_over_height / step.duration}, stereo);
  Eigen::Matrix<double, 3, 6> by_step;
  by_step << -crossMatrix(g), g * g.normalized().transpose();
  by_step /= step.duration;
  addVariance(by_step * step.covariance * by_step.transpose(), stereo);
}

}  // namespace uav_landing
