#include "far/sighted_ground.h"

#include "geometry/bias_variance.h"
#include "rig/rig_rotation.h"

namespace uav_landing {
namespace {

// From afar a rig that bends in flight has to be noticed within seconds, as nothing else shows it.
constexpr double kMemory = 3;  // s
constexpr double kGate = 3;    // sigmas

}  // namespace

SightedGround::SightedGround(const StereoRig& rig) : rig_(rig), rotation_(rig, kMemory) {}

void SightedGround::reset() {
  rotation_.reset();
  last_stamp_.reset();
  seen_.reset();
}

KnownGround SightedGround::of(const StereoDepthResult& stereo, bool has_plane, const AttitudePrior& imu) {
  if (last_stamp_ && !(stereo.stamp >= *last_stamp_)) reset();
  last_stamp_ = stereo.stamp;
  rotation_.advance(stereo.stamp);
  rotation_.setPrior(stereo.disparity_bias_stddev, stereo.row_bias_stddev);
  rotation_.updateVertical(stereo.vertical_rotation);
  KnownGround ground;
  ground.right = {stereo.vertical_rotation, rotation_.rotation()};
  seen_.reset();
  if (!has_plane) {
    if (!imu.failure) ground.normal = GroundNormal::of(imu.normal, imu.normal_covariance);
    return ground;
  }
  seen_ = Seen{stereo.plane, planeByRotation(rig_, stereo.points, PlaneVector(stereo.plane.g))};
  seen_->plane.covariance(2, 2) -= biasVariance(rig_, stereo.disparity_bias_stddev);
  const Eigen::Matrix3d& A = seen_->by_rotation;
  ground.plane = {seen_->plane.g - A * ground.right.turned.w,
                  seen_->plane.covariance + A * ground.right.turned.covariance * A.transpose()};
  ground.normal = normalOf(ground.plane);
  return ground;
}

void SightedGround::learn(const ApproachAngleResult::Motion& motion) {
  if (!seen_ || motion.failure) return;
  RigRotationFilter::Others others;
  others.moving = GroundNormal::of(motion.normal, motion.normal_covariance);
  rotation_.correct(seen_->plane, seen_->by_rotation, others, kGate);
  rotation_.settle(true);
}

}  // namespace uav_landing
