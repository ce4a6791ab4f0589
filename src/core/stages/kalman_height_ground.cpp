// The part of KalmanHeightStage that keeps the ground below in mind, for the protection level.

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

// 1 sigma of pitch and roll since the pair before where no motion tells them but the ground's normals, rad.
constexpr double kTurnByNormals = 0.1 * M_PI / 180;
// 1 sigma by which a step may climb otherwise than the height does, of its length: the ground slopes.
constexpr double kSlope = 0.05;

/// A camera that hardly moves turns all the same, but an unusual turn is confirmed by nothing then.
bool knowsTurn(const ApproachAngleResult::Motion& step, double T) {
  return step.rotation.allFinite() &&
         (!step.failure || step.rotation.norm() <= AttitudeFilter::kUnusualTurn * T);
}

}  // namespace

// Whether a step can be the way of the camera over T: one wrong step would lift all that is remembered.
// height: above the plane ahead. normal: of the ground now, where known.
bool KalmanHeightStage::agreesWithFlight(const ApproachAngleResult::Motion& step, double T, double height,
                                         const std::optional<Eigen::Vector3d>& normal) const {
  const Eigen::Vector3d& t = step.translation_over_height;
  if (!t.allFinite() || !(height > 0)) return false;
  if (!(std::abs(T - step.duration) <= AttitudeFilter::kStampRounding)) return false;
  if (!filter_.initialised() || !normal) return true;
  const Eigen::Matrix3d covariance = step.covariance.bottomRightCorner<3, 3>();
  const double off = height * normal->dot(t) + T * filter_.state()[1];
  const double flight_variance =
      std::pow(kSlope, 2) * t.squaredNorm() + T * T * filter_.covariance()(1, 1) / (height * height);
  // A step that claims to know less than the flight so far is not one to carry the ground by.
  const double own_variance = std::min(normal->dot(covariance * *normal), flight_variance);
  const double variance = height * height * (own_variance + flight_variance);
  return off * off <= std::pow(parameters_.gate, 2) * variance;
}

void KalmanHeightStage::rememberGround(const StereoDepthResult& stereo,
                                       const ApproachAngleResult::Motion& step,
                                       const Reconstruction& reconstruction, bool rejected) {
  if (!parameters_.integrity_monitor) return;
  if (stereo.left_repeated) return ground_.wait();
  ground_height_ = heightSoFar(reconstruction);
  const double T = ground_stamp_ ? stereo.stamp - *ground_stamp_ : 0;
  ground_stamp_ = stereo.stamp;
  // Above the plane ahead, which the motion is of.
  const double height = heightSoFar(reconstruction) - reconstruction.bend;
  const bool believed = !rejected && reconstruction.plane.valid() && attitude_.settled();
  const std::optional<Eigen::Vector3d> before = last_normal_;
  const bool turn_known = knowsTurn(step, T);
  const Eigen::Matrix3d R = turn_known ? rotationMatrix(step.rotation) : Eigen::Matrix3d::Identity();
  if (believed)
    last_normal_ = reconstruction.normal.n;
  else if (before)
    last_normal_ = R * *before;

  if (T > 0 && turn_known && !attitude_.doubtsTurn() && agreesWithFlight(step, T, height, last_normal_)) {
    if (believed) ground_.settleTurn(R.transpose() * *last_normal_, kTurnByNormals);
    ground_.move(R, height * step.translation_over_height, T);
  } else {
    const bool doubted = turn_known && attitude_.doubtsTurn();
    const double turn_stddev = doubted ? step.rotation.norm() : AttitudeFilter::kTurnRate * T;
    ground_.coast(doubted ? R : Eigen::Matrix3d::Identity(), turn_stddev, T, before, doubted);
    if (believed) ground_.settleTurn(*last_normal_, kTurnByNormals);
  }
  if (!believed || reconstruction.failure || reconstruction.by_width) return;
  const GroundPlane plane{reconstruction.normal.n / reconstruction.plane.height(),
                          reconstruction.plane.covariance};
  ground_.look(rig_, stereo.points, plane, stereo.plane.g);
}

Eigen::Vector3d KalmanHeightStage::knownNormal(const Reconstruction& reconstruction,
                                               const ApproachAngleResult& approach) const {
  if (reconstruction.plane.valid()) return reconstruction.normal.n;
  return approach.n.allFinite() ? approach.n : last_normal_.value_or(approach.n);
}

}  // namespace uav_landing
