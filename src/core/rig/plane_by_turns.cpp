#include "rig/plane_by_turns.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/cross_matrix.h"

namespace uav_landing {
namespace {

// How a rotation of the camera at one time within the readout changes the plane.
struct RowEffect {
  double share = 0;  // time since the stamp, as a share of the readout
  Eigen::Matrix3d by_rotation = Eigen::Matrix3d::Zero();
};

// By the points of the plane, those of about the same time together. Empty when there are too few.
std::vector<RowEffect> effectsOf(const StereoRig& rig, const RowTimes& times,
                                 const StereoDepthResult& stereo) {
  constexpr int kInReadout = 16;  // the fastest vibration has a quarter of a cycle in the time between
  constexpr size_t kFewest = 20;
  struct Points {
    double shares = 0;
    size_t count = 0;
    Eigen::Matrix3d rays = Eigen::Matrix3d::Zero();  // sum of r r'
  };
  std::map<int, Points> rows;
  Points all;
  for (const StereoDepthResult::Point& point : stereo.points) {
    if (!point.on_plane) continue;
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    const double share = times.at(point.u, point.v) / times.readoutTime();
    for (Points* points : {&all, &rows[static_cast<int>(std::floor(kInReadout * share))]}) {
      points->shares += share;
      ++points->count;
      points->rays += ray * ray.transpose();
    }
  }
  std::vector<RowEffect> effects;
  if (all.count < kFewest) return effects;
  const Eigen::LDLT<Eigen::Matrix3d> fit(all.rays);
  for (const auto& [row, points] : rows)
    effects.push_back({points.shares / points.count, -fit.solve(points.rays) * crossMatrix(stereo.plane.g)});
  return effects;
}

// One axis may have all of the vibration, so each gets three times the mean variance.
Eigen::Matrix3d covarianceBy(const Vibration& vibration, const std::vector<RowEffect>& effects) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const RowEffect& one : effects)
    for (const RowEffect& other : effects)
      covariance +=
          vibration.alike(one.share - other.share) * one.by_rotation * other.by_rotation.transpose();
  return 3 * vibration.stddev * vibration.stddev * covariance;
}

}  // namespace

ApproachAngleResult::PlaneByTurns planeByTurns(const StereoRig& rig, const RowTimes& times,
                                               const TurnsBetweenRows& turns,
                                               const StereoDepthResult& stereo) {
  constexpr double kLeft = 0.3;  // share of what was measured that stays
  ApproachAngleResult::PlaneByTurns by_turns;
  const bool measured = turns.measured.rows != nullptr, shakes = turns.vibration.found();
  if (times.atOnce() || !(measured || shakes) || !stereo.plane.valid()) return by_turns;
  std::vector<RowEffect> effects = effectsOf(rig, times, stereo);
  if (effects.empty()) return by_turns;
  if (measured) {
    for (const RowEffect& row : effects)
      by_turns.mean += row.by_rotation * turns.measured.at(row.share * times.readoutTime());
    by_turns.covariance = kLeft * kLeft * by_turns.mean * by_turns.mean.transpose();
  }
  if (shakes) {
    effects.push_back({0, crossMatrix(stereo.plane.g)});  // the plane is wanted as it is at the stamp
    by_turns.covariance += covarianceBy(turns.vibration, effects);
  }
  return by_turns;
}

Eigen::Matrix3d takeOff(const ApproachAngleResult::PlaneByTurns& by_turns, StereoDepthResult& stereo) {
  constexpr double kMost = 0.1;  // of the plane: vibration is far smaller
  if (!stereo.plane.valid()) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d left = by_turns.covariance;
  if (by_turns.mean.norm() > kMost * stereo.plane.g.norm()) {
    left += by_turns.mean * by_turns.mean.transpose();
  } else {
    stereo.plane.g -= by_turns.mean;
    if (stereo.below.valid()) stereo.below.g -= by_turns.mean;
  }
  stereo.plane.covariance += left;
  if (stereo.below.valid()) stereo.below.covariance += left;
  stereo.row_covariance += left;
  return left;
}

}  // namespace uav_landing
