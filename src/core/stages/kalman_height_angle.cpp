// The part of KalmanHeightStage that says how far the approach angle is to be believed.

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// Variance of an angle for the sake of the ground's normal: approach_angle knows nothing of the rig's
/// rotation nor of the pairs before, and took another one than is believed here. Its matches may have made up
/// for that or not, so the turn of the normal along the direction of motion counts as 1 sigma.
double normalAngleVariance(const Eigen::Vector3d& normal, const ApproachAngleResult& approach,
                           const ApproachAngleResult::Motion& motion) {
  const Eigen::Vector3d turn = normal - approach.n, &t = motion.translation_over_height;
  if (!turn.allFinite()) return 0;
  const double along = t.allFinite() ? turn.dot(t.normalized()) : turn.norm();
  return std::pow(along / std::cos(motion.angle), 2);
}

}  // namespace

// Of a plane and a vanishing point that contradict each other either may be right. But a wrong vanishing
// point comes and goes, and a plane that turns does so against the pairs before.
std::vector<Eigen::Vector3d> KalmanHeightStage::groundNormals(const Reconstruction& reconstruction,
                                                              const ApproachAngleResult& approach) const {
  std::vector<Eigen::Vector3d> normals;
  if (reconstruction.tilted)
    normals.push_back(reconstruction.normal.mean);
  else if (parameters_.rig_watch && reconstruction.plane.valid())
    normals.push_back(reconstruction.plane.normal());
  if (tests_.failed(Consistency::kVanishingPoint)) {
    const Eigen::Vector3d n = reconstruction.alone.normal(), &p = approach.vanishing_direction;
    const bool lasts = tests_.result(Consistency::kVanishingPoint).consecutive_failures + 1 >= kConfirmations;
    const bool turned = tests_.result(Consistency::kTilt).ratio > AttitudeFilter::kDoubtful;
    if (lasts || turned) normals.push_back((n - n.dot(p) * p).normalized());
  }
  return normals;
}

// jump: why the stamp says nothing of the time since the pair before, if so.
void KalmanHeightStage::reportAngle(const ApproachAngleResult& approach, const Reconstruction& reconstruction,
                                    const Failure& jump, LandingResult& result) const {
  const ApproachAngleResult::Motion& motion = publishedMotion(approach);
  const std::vector<Eigen::Vector3d> normals = groundNormals(reconstruction, approach);
  const auto byNormal = [&](const ApproachAngleResult::Motion& m) {
    double variance = 0;
    for (const Eigen::Vector3d& n : normals)
      variance = std::max(variance, normalAngleVariance(n, approach, m));
    return variance;
  };
  result.raw_approach_angle = approach.step.angle;
  result.raw_approach_angle_variance = approach.step.angle_variance + byNormal(approach.step);
  result.foe = approach.foe;
  result.approach_angle = motion.angle;
  result.approach_angle_variance = motion.angle_variance + byNormal(motion);

  Failure failure = approach.failure ? approach.failure : motion.failure;
  if (!failure && reconstruction.refused) failure = reconstruction.failure;
  // While the height waits for contradictions to end, so does the angle, which is of the same images.
  if (!failure && recovery_.pending()) failure = result.failure;
  if (!failure) failure = jump;
  if (!failure && !std::isfinite(motion.angle))
    failure = {Reason::kNoMotion, "the approach angle is not finite"};
  const double stddev = std::sqrt(result.approach_angle_variance);
  const double limit = parameters_.max_angle_stddev_deg * kDegree;
  if (!failure && !(stddev <= limit))
    failure = {Reason::kUncertain, text("approach angle has 1 sigma of ", stddev / kDegree,
                                        " deg, more than ", parameters_.max_angle_stddev_deg, " deg")};
  result.angle_valid = !failure;
  if (!result.failure) result.failure = failure;
}

}  // namespace uav_landing
