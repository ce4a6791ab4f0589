#include "uav_landing/geometry/camera_pair.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "uav_landing/geometry/rig_check.h"

namespace uav_landing {
namespace {

// Shares of the baseline. Below kLevel the pair stays as it is, as it is as good as level. Above kAslant
// another P was meant.
constexpr double kLevel = 1e-3, kAslant = 0.02;

/// From the left to the right camera, in rectified axes, m.
Eigen::Vector3d baselineOf(const CameraCalibration& left, const CameraCalibration& right) {
  const auto translation = [](const CameraCalibration& c) -> Eigen::Vector3d {
    return c.P.leftCols<3>().inverse() * c.P.col(3);
  };
  return translation(left) - translation(right);
}

/// Puts the left camera at the origin and the right one beside it.
void place(double baseline, CameraPair& pair) {
  pair.left.P.col(3).setZero();
  pair.right.P.col(3) << -pair.right.P(0, 0) * baseline, 0, 0;
}

/// Turns both rectified cameras so that the right one stands exactly to the right of the left one.
void levelRows(CameraPair& pair) {
  if (checkCalibration(pair.left) || checkCalibration(pair.right)) return;
  const Eigen::Vector3d baseline = baselineOf(pair.left, pair.right);
  const double aslant = std::max(std::abs(baseline.y()), std::abs(baseline.z()));
  if (!(aslant > kLevel * baseline.x() && aslant <= kAslant * baseline.x())) return;
  Eigen::Matrix3d turn;
  turn.row(0) = baseline.normalized();
  turn.row(1) = Eigen::Vector3d::UnitZ().cross(baseline).normalized();
  turn.row(2) = turn.row(0).cross(turn.row(1));
  pair.left.R = turn * pair.left.R;
  pair.right.R = turn * pair.right.R;
  place(baseline.norm(), pair);
}

/// Turns the rectified camera about its optical axis. Its image then is the old one turned by 180 deg.
void turnOver(CameraCalibration& camera) {
  const cv::Size size = camera.imageSize();
  const Eigen::Vector2d offset(camera.roi.x, camera.roi.y), last(size.width - 1, size.height - 1);
  const Eigen::Vector2d binning(std::max(camera.binning_x, 1), std::max(camera.binning_y, 1));
  const Eigen::DiagonalMatrix<double, 3> half_turn(-1, -1, 1);
  camera.R = half_turn * camera.R;
  for (int i = 0; i < 2; ++i) camera.P(i, 2) = 2 * offset[i] + binning[i] * last[i] - camera.P(i, 2);
}

}  // namespace

Expected<CameraPair> workingPair(const CameraCalibration& left, const CameraCalibration& right,
                                 const RigParameters& parameters) {
  CameraPair pair{left, right};
  levelRows(pair);
  const Expected<StereoRig> rig = makeStereoRig(pair.left, pair.right, parameters);
  if (!rig) return tl::unexpected<Failure>(rig.error());
  if (!parameters.upside_down) return pair;
  std::swap(pair.left, pair.right);
  turnOver(pair.left);
  turnOver(pair.right);
  place(rig->baseline, pair);
  return pair;
}

}  // namespace uav_landing
