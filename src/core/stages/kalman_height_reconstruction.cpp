// The part of KalmanHeightStage that makes a height of one pair: the plane, freed of the rig's rotation and
// fused with what else is known of the ground, its attitude, and the second height by the runway's width.

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/bias_variance.h"
#include "rig/pair_skew.h"
#include "uav_landing/height/reconstruction.h"
#include "uav_landing/rig/rig_rotation.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
// 1 sigma of a plane's height over itself: with more, what is linear in its errors has no meaning, and any
// direction seems to lie in it.
constexpr double kLargestRelative = 0.3;

/// plane: with what the pair's skew adds to its covariance.
Failure missingPlane(const StereoDepthResult& stereo, const GroundPlane& plane) {
  if (stereo.failure) return stereo.failure;
  if (!plane.valid() || !plane.covariance.allFinite())
    return {Reason::kNoPlane, "the ground plane has no finite value and covariance"};
  const double relative = std::sqrt(plane.heightVariance()) / plane.height();
  if (!(relative <= kLargestRelative))
    return {Reason::kUncertain, text("the height of the ground plane has 1 sigma of ", rounded(relative),
                                     " of itself, more than ", kLargestRelative)};
  return {};
}

/// Share of a pair's own error that is the same in the pairs of a second, as they see the same texture.
double lastingShare(const StereoDepthResult& stereo) {
  // Of what is no noise, by the simulator's errors of one pair and of a dozen.
  constexpr double kLasting = 0.5;
  constexpr double kOfMatches = 1.0 / 3;  // of all, where nobody knows what is noise
  return std::isfinite(stereo.lasting_share) ? kLasting * stereo.lasting_share : kOfMatches;
}

}  // namespace

const ApproachAngleResult::Motion& KalmanHeightStage::publishedMotion(const ApproachAngleResult& approach) {
  const bool window_known = !approach.window.failure && std::isfinite(approach.window.angle);
  return window_known ? approach.window : approach.step;
}

GroundNormal KalmanHeightStage::normalByMotion(const ApproachAngleResult& approach) {
  const ApproachAngleResult::Motion& motion = publishedMotion(approach);
  return motion.failure ? GroundNormal{} : GroundNormal{motion.normal, motion.normal_covariance};
}

ApproachAngleResult::Motion KalmanHeightStage::turnSince(const ApproachAngleResult& approach) const {
  const AttitudePrior& imu = approach.imu;
  if (!parameters_.fuse_imu || !approach.step.failure || !imu.hasRotation()) return approach.step;
  ApproachAngleResult::Motion turn;
  turn.duration = imu.duration;
  turn.rotation = imu.rotation;
  turn.covariance.setZero();
  turn.covariance.topLeftCorner<3, 3>() = imu.rotation_covariance;
  return turn;
}

double KalmanHeightStage::modelVariance(double height) const {
  return std::pow(parameters_.height_model_error * height, 2) + surface_variance_ + bend_variance_ +
         averaging_variance_;
}

CommonVariance KalmanHeightStage::commonVariance(double height) const {
  return {modelVariance(height) - bend_variance_ + rig_variance_, bend_variance_, width_variance_};
}

void KalmanHeightStage::useWidth(const ApproachAngleResult::Runway& runway, Reconstruction& reconstruction,
                                 LandingResult& result) {
  constexpr double kAgreement = 3;  // sigma
  width_variance_ = 0;
  reconstruction.stereo_height = reconstruction.height;
  reconstruction.stereo_variance = reconstruction.variance;
  if (runway.failure) return;
  std::optional<WidthHeight::Estimate> seen = width_.height(runway.width, runway.width_variance);
  // What the width itself is wrong by does not tell whether it is that of the same edges.
  const CommonVariance common = filter_.commonVariance();
  const bool by_stereo = !reconstruction.failure;
  const bool same =
      !seen || !filter_.initialised() || confirmations_ < kConfirmations ||
      width_.isSame(runway.width, runway.width_variance, filter_.state()[0] - reconstruction.bend,
                    filter_.ownCovariance()(0, 0) + common.lasting + common.bend);
  // A known one is reported nevertheless: the fault may as well be the heights'.
  if (!same && !width_.independent()) seen.reset();
  if (seen) {
    result.width_height = seen->height + reconstruction.bend;
    result.width_height_variance = seen->variance + modelVariance(seen->height);
  }
  reconstruction.teaches_width = by_stereo && confirmations_ >= kConfirmations;
  if (seen && parameters_.fuse_width_height) {
    // What was refused for its tilt is the ground that the width was seen on, too.
    if (!by_stereo && same && !reconstruction.tilted && confirmations_ >= kConfirmations) {
      reconstruction.failure = {};
      reconstruction.height = result.width_height;
      reconstruction.variance = result.width_height_variance;
      width_variance_ = seen->common;
      reconstruction.by_width = true;
    } else if (by_stereo && same && width_.independent()) {
      const double difference = result.width_height - reconstruction.height;
      const double sum = seen->variance + reconstruction.variance;
      if (difference * difference <= kAgreement * kAgreement * sum) {
        const double model = modelVariance(reconstruction.height), own = reconstruction.variance - model;
        const double gain = own / (own + seen->variance);
        reconstruction.height += gain * difference;
        width_variance_ = gain * gain * seen->common;
        reconstruction.variance = own * seen->variance / (own + seen->variance) + model;
      }
    }
  }
}

void KalmanHeightStage::learnWidth(const ApproachAngleResult::Runway& runway,
                                   const Reconstruction& reconstruction, const LandingResult& result) {
  if (!reconstruction.teaches_width || reconstruction.failure || result.rejected) return;
  width_.learn(runway.width, runway.width_variance, reconstruction.height - reconstruction.bend,
               reconstruction.variance);
}

void KalmanHeightStage::followSurface(double surface_variance) {
  constexpr int kPairs = 20;
  if (!std::isfinite(surface_variance)) return;
  surface_pairs_ = filter_.initialised() ? std::min(surface_pairs_ + 1, kPairs) : 1;
  const double share = 1.0 / surface_pairs_, before = surface_pairs_ > 1 ? surface_mean_ : surface_variance;
  surface_mean_ = before + share * (surface_variance - before);
  const double square = (surface_variance - before) * (surface_variance - surface_mean_);
  surface_scatter_ += share * (square - surface_scatter_);
  // Each pair's is the small difference of two large variances: of flat ground it scatters around zero. What
  // is within its mean's own error is not believed, once there are enough of them to tell.
  constexpr int kEnough = 5;
  const double error = surface_pairs_ < kEnough ? 0 : std::sqrt(surface_scatter_ / surface_pairs_);
  surface_variance_ = std::max(0.0, surface_mean_ - error);
}

void KalmanHeightStage::followBend(const StereoDepthResult& stereo, Reconstruction& reconstruction) {
  reconstruction.below = reconstruction.plane;
  bend_variance_ = 0;
  last_bend_ = {0, 0, stereo.stamp};
  if (!stereo.below.valid() || parameters_.height_source != HeightSource::kPlane) return;
  // What corrects the plane of the surface ahead corrects the tangent likewise: both are of the same images.
  reconstruction.below.g += stereo.below.g - stereo.plane.g;
  reconstruction.bend = reconstruction.below.height() - reconstruction.plane.height();
  bend_variance_ = std::max(0.0, stereo.below.heightVariance() - stereo.plane.heightVariance());
  last_bend_ = {reconstruction.bend, bend_variance_, stereo.stamp};
}

// The ground ahead is soon another one.
void KalmanHeightStage::carryBend(double stamp, Reconstruction& reconstruction) {
  constexpr double kLasts = 1;  // s, after which the bend may as well be none or twice as large
  if (!last_bend_) return;
  reconstruction.bend = last_bend_->height;
  bend_variance_ =
      last_bend_->variance + std::pow(last_bend_->height * (stamp - last_bend_->stamp) / kLasts, 2);
}

KalmanHeightStage::Reconstruction KalmanHeightStage::reconstruct(const StereoDepthResult& stereo,
                                                                 const ApproachAngleResult& approach) {
  const ScopedTimer timer(timings_, "reconstruction");
  averaging_variance_ = 0;
  Reconstruction reconstruction;
  const GroundPlane measured = withSkew(rig_, stereo, approach.step);
  reconstruction.failure = missingPlane(stereo, measured);
  if (reconstruction.failure) {
    carryBend(stereo.stamp, reconstruction);
    return reconstruction;
  }

  followSurface(stereo.surface_variance);
  findPlane(measured, stereo, approach, reconstruction);
  followBend(stereo, reconstruction);
  const Eigen::Vector3d n = reconstruction.plane.normal();
  reconstruction.normal = {n, reconstruction.plane.normalCovariance()};
  reconstruction.points_height = averageHeight(rig_, stereo.points, -pitchOf(n), rollOf(n), true).height;
  if (parameters_.height_source == HeightSource::kPlane) {
    reconstruction.height = reconstruction.below.height();
    reconstruction.variance = reconstruction.plane.heightVariance();
  } else {
    reconstructFromPoints(stereo, approach, reconstruction);
  }
  reconstruction.variance += modelVariance(reconstruction.height);
  if (!reconstruction.failure && !(reconstruction.height > 0 && reconstruction.variance >= 0))
    reconstruction.failure = {
        Reason::kNoPlane, text("height of ", rounded(reconstruction.height), " m is not above the ground")};
  return reconstruction;
}

void KalmanHeightStage::findPlane(const GroundPlane& measured, const StereoDepthResult& stereo,
                                  const ApproachAngleResult& approach, Reconstruction& reconstruction) {
  GroundPlane& plane = reconstruction.plane;
  Eigen::Matrix3d& common = reconstruction.common;
  plane = measured;
  common = stereo.row_covariance;
  common(2, 2) += biasVariance(rig_, stereo.disparity_bias_stddev);
  reconstruction.alone = plane;
  reconstruction.alone_common = common;
  if (parameters_.rig_watch) return watchRig(stereo, approach, reconstruction);
  // Only these are independent of the stereo plane; the fused normal of the approach angle contains it.
  const RigRotationFilter::Others others = otherSources(stereo, approach);
  if (others.vanishing.known()) fuseDirection(others.vanishing, reconstruction);
  for (const GroundNormal& normal : {others.level, others.moving})
    if (normal.known())
      for (const GroundDirection& level : levelDirections(normal)) fuseDirection(level, reconstruction);
  rig_variance_ = GroundPlane{plane.g, common}.heightVariance();
}

void KalmanHeightStage::fuseDirection(const GroundDirection& ground, Reconstruction& reconstruction) const {
  const GroundPlane alone = reconstruction.plane;
  const Eigen::Vector3d& p = ground.direction;
  double nis = 0;
  reconstruction.plane =
      fuseVanishingPoint(alone, p, ground.covariance, std::pow(parameters_.vanishing_point_gate, 2), &nis);
  if (reconstruction.plane.g == alone.g) return;
  // What the direction is wrong by is mostly the ground's own slope, or of the same images: the next pairs
  // have the same.
  const double variance = alone.g.dot(ground.covariance * alone.g);
  const Eigen::Vector3d gain = alone.covariance * p / (p.dot(alone.covariance * p) + variance);
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * p.transpose();
  Eigen::Matrix3d& common = reconstruction.common;
  common = (kept * common * kept.transpose()).eval() + variance * gain * gain.transpose();
}

void KalmanHeightStage::averageAttitude(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                                        Reconstruction& reconstruction, LandingResult& result) {
  const GroundPlane& plane = reconstruction.plane;
  const ApproachAngleResult::Motion turn = turnSince(approach);
  if (!plane.valid()) return attitude_.carry(stereo.stamp, turn);
  GroundNormal& average = reconstruction.normal;
  if (!parameters_.average_attitude) return;
  const Eigen::Matrix3d common = GroundPlane{plane.g, reconstruction.common}.normalCovariance();
  const Eigen::Matrix3d own = average.covariance - common;
  const double lasting = lastingShare(stereo);
  const AttitudeFilter::Estimate estimate =
      attitude_.update(stereo.stamp, plane.normal(), own, turn, common + lasting * own, 1 - lasting);
  average = {estimate.normal, estimate.average_covariance + estimate.commonCovariance()};
  const double off = std::acos(std::min(1.0, plane.normal().dot(estimate.normal)));
  if (std::isfinite(estimate.ratio))
    tests_.addRatio(Consistency::kTilt, off, estimate.ratio, AttitudeFilter::kGate);
  if (estimate.agrees || reconstruction.failure) return;
  reconstruction.tilted = true;
  refusePair({Reason::kRejected, text("the ground plane is tilted by ", rounded(off / kDegree),
                                      " deg against the pairs before and the rotation since")},
             reconstruction, result);
}

RigRotationFilter::Others KalmanHeightStage::otherSources(const StereoDepthResult& stereo,
                                                          const ApproachAngleResult& approach) const {
  RigRotationFilter::Others others;
  if (parameters_.fuse_vanishing_point)
    others.vanishing = {approach.vanishing_direction, approach.vanishing_covariance};
  if (parameters_.fuse_imu) others.level = {approach.imu.normal, approach.imu.normal_covariance};
  if (parameters_.fuse_motion_normal && !stereo.left_repeated) others.moving = normalByMotion(approach);
  return others;
}

void KalmanHeightStage::watchRig(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                                 Reconstruction& reconstruction) {
  rig_rotation_.advance(stereo.stamp);
  rig_rotation_.setPrior(stereo.disparity_bias_stddev, stereo.row_bias_stddev);
  if (!rig_change_.doubts(stereo.vertical_rotation)) rig_rotation_.updateVertical(stereo.vertical_rotation);
  // The rig's error is in the plane's covariance as a bias of all disparities; here it is a state of its own.
  GroundPlane without = reconstruction.plane;
  without.covariance(2, 2) -= biasVariance(rig_, stereo.disparity_bias_stddev);
  const Eigen::Matrix3d A = planeByRotation(rig_, stereo.points, without.g);
  const RigRotation rotation = rig_rotation_.rotation();
  if (rotation.known()) {
    const Eigen::Matrix3d by_rotation = A * rotation.covariance * A.transpose();
    reconstruction.alone_common = by_rotation + stereo.row_covariance;
    reconstruction.alone = {without.g - A * rotation.w, without.covariance + by_rotation};
  }
  const RigRotationFilter::Corrected corrected =
      rig_rotation_.correct(without, A, otherSources(stereo, approach), parameters_.vanishing_point_gate);
  reconstruction.plane = corrected.plane;
  reconstruction.common =
      corrected.common + corrected.kept * stereo.row_covariance * corrected.kept.transpose();
  rig_variance_ = GroundPlane{corrected.plane.g, reconstruction.common}.heightVariance();
}

void KalmanHeightStage::reconstructFromPoints(const StereoDepthResult& stereo,
                                              const ApproachAngleResult& approach,
                                              Reconstruction& reconstruction) {
  const Eigen::Vector3d n = reconstruction.plane.normal();
  double theta = -pitchOf(n), roll = rollOf(n);
  double theta_variance = pitchVariance(n, reconstruction.plane.normalCovariance());
  bool only_on_plane = true;
  if (parameters_.reconstruction_angle == ReconstructionAngle::kApproach) {
    // The paper to the letter: no roll, and a statistical average over every depth.
    theta = publishedMotion(approach).angle;
    theta_variance = publishedMotion(approach).angle_variance;
    roll = 0;
    only_on_plane = false;
  }
  if (!std::isfinite(theta) || !std::isfinite(theta_variance)) {
    reconstruction.failure = approach.failure ? approach.failure : publishedMotion(approach).failure;
    if (!reconstruction.failure)
      reconstruction.failure = {Reason::kNoMotion, "no approach angle to reconstruct the height with"};
    return;
  }
  const AveragedHeight averaged = averageHeight(rig_, stereo.points, theta, roll, only_on_plane);
  if (averaged.points < 2) {
    reconstruction.failure = {Reason::kTooFewMatches,
                              text(averaged.points, " of at least 2 points to average")};
    return;
  }
  // d height / d theta of eq (5) is the rotated depth: the same sum a quarter turn further.
  const double by_theta = averageHeight(rig_, stereo.points, theta + M_PI / 2, roll, only_on_plane).height;
  reconstruction.height = averaged.height;
  reconstruction.variance = averaged.variance + by_theta * by_theta * theta_variance;
  // Depths of far points are too large on average, an angle of another meaning and matches off the ground
  // make errors of their own, and the scatter knows nothing of it. What the average differs from the plane by
  // is a measure of it, which the next pairs repeat.
  averaging_variance_ = std::pow(averaged.height - reconstruction.plane.height(), 2);
}

}  // namespace uav_landing
