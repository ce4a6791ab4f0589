#include "rig/plane_by_turns.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "geometry/cross_matrix.h"

namespace uav_landing {
namespace {

// Products r r' of the rays of the plane's points, over all points and by the time of their row.
struct PointsByRow {
  static constexpr int kInReadout = 16;  // the fastest vibration has a quarter of a cycle in the time between
  std::map<int, Eigen::Matrix3d> rows;
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  size_t count = 0;

  bool enough() const { return count >= 20; }
};

PointsByRow pointsByRow(const StereoRig& rig, const RowTimes& times, const StereoDepthResult& stereo) {
  PointsByRow points;
  for (const StereoDepthResult::Point& point : stereo.points) {
    if (!point.on_plane) continue;
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    const double share = times.at(point.u, point.v) / times.readoutTime();
    const auto row = static_cast<int>(std::floor(PointsByRow::kInReadout * share));
    const Eigen::Matrix3d product = ray * ray.transpose();
    points.rows.try_emplace(row, Eigen::Matrix3d::Zero()).first->second += product;
    points.all += product;
    ++points.count;
  }
  return points;
}

Eigen::Vector3d meanByTurns(const StereoRig& rig, const RowTimes& times, const GyroTurn& turns,
                            const StereoDepthResult& stereo, const PointsByRow& points) {
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const StereoDepthResult::Point& point : stereo.points) {
    if (!point.on_plane) continue;
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    right += ray * ray.dot(turns.at(times.at(point.u, point.v)).cross(stereo.plane.g));
  }
  return points.all.ldlt().solve(right);
}

// The plane is wanted as it is at the stamp, where the share is 0. One axis may have all of the vibration, so
// each gets three times the mean variance.
Eigen::Matrix3d covarianceBy(const Vibration& vibration, const Eigen::Vector3d& g,
                             const PointsByRow& points) {
  const Eigen::LDLT<Eigen::Matrix3d> all(points.all);
  std::map<int, Eigen::Matrix3d> by_rotation;
  for (const auto& [row, products] : points.rows) by_rotation[row] = -all.solve(products) * crossMatrix(g);
  by_rotation.try_emplace(0, Eigen::Matrix3d::Zero()).first->second += crossMatrix(g);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [row, by_one] : by_rotation)
    for (const auto& [other, by_other] : by_rotation)
      covariance +=
          vibration.alike(double(row - other) / PointsByRow::kInReadout) * by_one * by_other.transpose();
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
  const PointsByRow points = pointsByRow(rig, times, stereo);
  if (!points.enough()) return by_turns;
  if (measured) {
    by_turns.mean = meanByTurns(rig, times, turns.measured, stereo, points);
    by_turns.covariance = kLeft * kLeft * by_turns.mean * by_turns.mean.transpose();
  }
  if (shakes) by_turns.covariance += covarianceBy(turns.vibration, stereo.plane.g, points);
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
