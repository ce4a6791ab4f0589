#include "landing/height/ground_estimate.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/bias_variance.h"
#include "rig/pair_skew.h"
#include "rig/rig_rotation.h"

namespace uav_landing {
namespace {

// Largest 1 sigma of a plane's height, as a share of the height. Beyond it, linear error propagation has no
// meaning, and any direction seems to lie in the plane.
constexpr double kLargestRelative = 0.3;

/// plane: its covariance contains the effect of the pair's skew.
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

/// Share of a pair's own error that is the same in all pairs of about one second, because they see the same
/// texture.
double lastingShare(const StereoDepthResult& stereo) {
  // Share of the errors that are not noise. It comes from the simulator: errors of single pairs compared with
  // those of a dozen.
  constexpr double kLasting = 0.5;
  constexpr double kOfMatches = 1.0 / 3;  // of all errors, when it is not known which are noise
  return std::isfinite(stereo.lasting_share) ? kLasting * stereo.lasting_share : kOfMatches;
}

}  // namespace

Eigen::Vector3d Ground::positionNormalOr(const Eigen::Vector3d& otherwise) const {
  if (!plane.valid()) return otherwise;
  return tilted && normal ? normal->vector() : plane.normal();
}

GroundEstimate::GroundEstimate(const StereoRig& rig, const KalmanHeightParameters& parameters)
    : rig_(rig),
      parameters_(parameters),
      rig_rotation_(rig, parameters.rig_memory),
      surface_(parameters.height_source == HeightSource::kPlane) {}

Ground GroundEstimate::propose(const PairInput& in, bool rig_doubted, bool known) {
  Ground ground;
  const GroundPlane measured = withSkew(rig_, in.stereo, in.step());
  ground.failure = missingPlane(in.stereo, measured);
  if (ground.failure) {
    ground.surface = surface_.carry(in.stamp());
  } else {
    ground.plane = measured;
    findPlane(in, rig_doubted, ground);
    ground.surface = surface_.follow(in.stereo, ground.plane, known);
    ground.normal = normalOf(ground.plane);
  }
  ground.rig_variance = rig_variance_;
  if (!in.repeated()) averageNormal(in, ground);  // else the next motion starts before it
  ground.turn_doubted = attitude_.doubtsTurn();
  ground.attitude_settled = attitude_.settled();
  return ground;
}

void GroundEstimate::commit(bool believed, const std::optional<RigRotation>& turned) {
  if (turned) rig_rotation_.startAnew(*turned);
  // Images that do not belong together teach nothing about the rig.
  rig_rotation_.settle(believed);
}

void GroundEstimate::findPlane(const PairInput& in, bool rig_doubted, Ground& ground) {
  ground.common = in.stereo.row_covariance;
  ground.common(2, 2) += biasVariance(rig_, in.stereo.disparity_bias_stddev);
  ground.alone = ground.plane;
  ground.alone_common = ground.common;
  if (parameters_.rig_watch) {
    watchRig(in, rig_doubted, ground);
  } else {
    // Only these sources are independent of the stereo plane. The fused normal of the approach angle contains
    // it.
    const RigRotationFilter::Others others = otherSources(in);
    if (others.vanishing) turnInto(*others.vanishing, ground);
    for (const std::optional<GroundNormal>& normal : {others.level, others.moving})
      if (normal)
        for (const GroundDirection& level : levelDirections(*normal)) turnInto(level, ground);
  }
  rig_variance_ = GroundPlane{ground.plane.g, ground.common}.heightVariance();
}

// Turns the plane so that it contains a direction which lies in the ground.
void GroundEstimate::turnInto(const GroundDirection& direction, Ground& ground) const {
  const GroundPlane alone = ground.plane;
  const Eigen::Vector3d& p = direction.vector();
  double nis = 0;
  ground.plane = fuseDirection(alone, direction, std::pow(parameters_.vanishing_point_gate, 2), &nis);
  if (ground.plane.g == alone.g) return;
  // The error of the direction is mostly the ground's own slope, or comes from the same images. So the next
  // pairs have it as well.
  const double variance = alone.g.dot(direction.covariance() * alone.g);
  const Eigen::Vector3d gain = alone.covariance * p / (p.dot(alone.covariance * p) + variance);
  const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * p.transpose();
  ground.common = (kept * ground.common * kept.transpose()).eval() + variance * gain * gain.transpose();
}

RigRotationFilter::Others GroundEstimate::otherSources(const PairInput& in) const {
  const ApproachAngleResult& approach = in.approach;
  RigRotationFilter::Others others;
  if (parameters_.fuse_vanishing_point)
    others.vanishing = GroundDirection::of(approach.vanishing_direction, approach.vanishing_covariance);
  if (parameters_.fuse_imu)
    others.level = GroundNormal::of(approach.imu.normal, approach.imu.normal_covariance);
  if (parameters_.fuse_motion_normal && !in.repeated()) others.moving = in.normalByMotion();
  return others;
}

void GroundEstimate::watchRig(const PairInput& in, bool rig_doubted, Ground& ground) {
  const StereoDepthResult& stereo = in.stereo;
  rig_rotation_.advance(stereo.stamp);
  rig_rotation_.setPrior(stereo.disparity_bias_stddev, stereo.row_bias_stddev);
  if (!rig_doubted) rig_rotation_.updateVertical(stereo.vertical_rotation);
  // The plane's covariance contains the rig's error as a bias of all disparities. Here the rig is a state of
  // its own, so that part is taken out.
  GroundPlane without = ground.plane;
  without.covariance(2, 2) -= biasVariance(rig_, stereo.disparity_bias_stddev);
  const Eigen::Matrix3d A = planeByRotation(rig_, stereo.points, PlaneVector(without.g));
  const RigRotation rotation = rig_rotation_.rotation();
  if (rotation.known()) {
    const Eigen::Matrix3d by_rotation = A * rotation.covariance * A.transpose();
    ground.alone_common = by_rotation + stereo.row_covariance;
    ground.alone = {without.g - A * rotation.w, without.covariance + by_rotation};
  }
  const RigRotationFilter::Corrected corrected =
      rig_rotation_.correct(without, A, otherSources(in), parameters_.vanishing_point_gate);
  ground.plane = corrected.plane;
  ground.common = corrected.common + corrected.kept * stereo.row_covariance * corrected.kept.transpose();
}

void GroundEstimate::averageNormal(const PairInput& in, Ground& ground) {
  if (!ground.plane.valid()) return attitude_.carry(in.stamp(), in.turn);
  if (!parameters_.average_attitude || !ground.normal) return;
  const Eigen::Matrix3d common = GroundPlane{ground.plane.g, ground.common}.normalCovariance();
  const Eigen::Matrix3d own = ground.normal->covariance() - common;
  const double lasting = lastingShare(in.stereo);
  const AttitudeFilter::Estimate estimate = attitude_.update(in.stamp(), {ground.plane.normal(), own},
                                                             in.turn, common + lasting * own, 1 - lasting);
  ground.normal =
      GroundNormal::of(estimate.normal, estimate.average_covariance + estimate.commonCovariance());
  ground.tilt = std::acos(std::min(1.0, ground.plane.normal().dot(estimate.normal)));
  ground.tilt_ratio = estimate.ratio;
  ground.tilted = !estimate.agrees;
}

}  // namespace uav_landing
