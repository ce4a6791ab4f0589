#include "rig/plane_rate.h"

#include <Eigen/Geometry>

#include "geometry/cross_matrix.h"

namespace uav_landing {
namespace {

bool hasRowTimes(const StereoDepthResult& stereo) {
  return !stereo.plane_by_rate.isZero(0) && stereo.plane.valid();
}

void addToPlane(const Eigen::Matrix3d& added, StereoDepthResult& stereo) {
  stereo.plane.covariance += added;
  if (stereo.below.valid()) stereo.below.covariance += added;
}

void addVariance(const Eigen::Matrix3d& of_rate, StereoDepthResult& stereo) {
  addToPlane(stereo.plane_by_rate * of_rate * stereo.plane_by_rate.transpose(), stereo);
}

void carryTo(const Eigen::Vector3d& rate, StereoDepthResult& stereo) {
  const Eigen::Vector3d change = stereo.plane_by_rate * (rate - stereo.plane_rate);
  stereo.plane.g += change;
  if (stereo.below.valid()) stereo.below.g += change;
  stereo.plane_rate = rate;
}

// Does as if this readout time had been given and nothing had been carried yet. A becomes that of
// the estimated time.
Eigen::Vector3d takeReadout(const Eigen::Vector3d& rate, const ReadoutEstimate& readout,
                            StereoDepthResult& stereo) {
  const Eigen::Vector3d by_time = stereo.plane_by_rate * rate;
  const Eigen::Matrix3d variance = readout.variance * by_time * by_time.transpose();
  addToPlane(variance, stereo);
  stereo.row_covariance += variance;
  stereo.plane_by_rate *= readout.time;
  stereo.plane_rate.setZero();
  return by_time;
}

}  // namespace

Eigen::Vector3d carryPlane(const RowMotion& motion, const ReadoutEstimate& readout,
                           StereoDepthResult& stereo) {
  Eigen::Vector3d by_time = Eigen::Vector3d::Zero();
  if (!hasRowTimes(stereo)) return by_time;
  const Eigen::Vector3d rate = planeRate(PlaneVector(stereo.plane.g), motion);
  if (!readout.given()) by_time = takeReadout(rate, readout, stereo);
  carryTo(rate, stereo);
  return by_time;
}

Eigen::Vector3d carryPlane(const ReadoutEstimate& readout, StereoDepthResult& stereo) {
  if (!hasRowTimes(stereo) || readout.given()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d rate = stereo.plane_rate;
  const Eigen::Vector3d by_time = takeReadout(rate, readout, stereo);
  carryTo(rate, stereo);
  return by_time;
}

void carryPlane(const ApproachAngleResult::Motion& step, const ReadoutEstimate& readout,
                StereoDepthResult& stereo) {
  if (!hasRowTimes(stereo)) return;
  const bool known = step.duration > 0 && step.rotation.allFinite() &&
                     step.translation_over_height.allFinite() && step.covariance.allFinite();
  if (!known) {
    if (readout.given())
      addVariance(stereo.plane_rate * stereo.plane_rate.transpose(), stereo);
    else
      carryPlane(readout, stereo);
    return;
  }
  const Eigen::Vector3d g = stereo.plane.g;
  const Eigen::Vector3d rate = step.turn_rate.allFinite() ? step.turn_rate : step.rotation / step.duration;
  carryPlane(RowMotion{rate, step.translation_over_height / step.duration}, readout, stereo);
  Eigen::Matrix<double, 3, 6> by_step;
  by_step << -crossMatrix(g), g * g.normalized().transpose();
  by_step /= step.duration;
  addVariance(by_step * step.covariance * by_step.transpose(), stereo);
}

}  // namespace uav_landing
