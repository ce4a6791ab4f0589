#include "stereo/matching/plane_drift.h"

#include <Eigen/LU>

namespace uav_landing {

void carryToStamp(const StereoRig& rig, const PlaneDrift& drift, std::vector<DisparitySample>& samples) {
  if (drift.isStill()) return;
  for (DisparitySample& sample : samples) {
    const double added =
        drift.times->at(sample.u, sample.v) * rig.fb() * drift.rate.dot(rig.ray(sample.u, sample.v));
    sample.disparity -= added;
    for (double& other : sample.others) other -= added;
  }
}

Eigen::Matrix3d planeByRate(const StereoRig& rig, const PlaneDrift& drift,
                            const std::vector<DisparitySample>& samples, const std::vector<char>& agrees) {
  if (drift.isStill()) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero(), by_times = information;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (agrees[i] == 0) continue;
    const DisparitySample& sample = samples[i];
    const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v) / sample.stddev;
    information += row * row.transpose();
    by_times += drift.times->at(sample.u, sample.v) * row * row.transpose();
  }
  const Eigen::Matrix3d by_rate = -information.inverse() * by_times;
  return by_rate.allFinite() ? by_rate : Eigen::Matrix3d::Zero();
}

}  // namespace uav_landing
