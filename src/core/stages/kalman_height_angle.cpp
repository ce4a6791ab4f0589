// The part of KalmanHeightStage that says how far approach angle and velocity are to be believed.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/rotation.h"
#include "height/camera_twist.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

// Error that noise alone stays within with 95 %, squared and over its variance.
const double kCertain = chiSquareLimit(0.05, 1);

double along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& t) {
  return t.allFinite() ? t.dot(covariance * t) / t.squaredNorm() : covariance.trace();
}

/// By which share of itself the depth of the points on the plane is another one, in units of the height,
/// where the ground has the normal b instead of a.
double depthChange(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                   const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  double by_a = 0, by_b = 0;
  for (const StereoDepthResult::Point& point : points) {
    if (!point.on_plane) continue;
    const Eigen::Vector3d ray = rig.ray(point.u, point.v);
    by_a += a.dot(ray);
    by_b += b.dot(ray);
  }
  return by_a > 0 && by_b > 0 ? by_a / by_b - 1 : 0;
}

}  // namespace

// The normal that an angle of this motion is measured against: the one given with what the motion's own adds.
GroundNormal KalmanHeightStage::normalOfAngle(const ApproachAngleResult& approach,
                                              const ApproachAngleResult::Motion& motion) {
  const GroundNormal given{approach.n, approach.n_covariance}, own{motion.normal, motion.normal_covariance};
  return given.known() && own.known() ? weightedMean(given, own) : given;
}

// Variance of an angle that is measured against this normal, if the ground has the other one. The angle's
// matches may have made up for the difference or not, so its part along the direction of motion counts as 1
// sigma.
double KalmanHeightStage::OtherNormal::angleVariance(const Eigen::Vector3d& used,
                                                     const ApproachAngleResult::Motion& motion) const {
  const Eigen::Vector3d turn = normal - used, &t = motion.translation_over_height;
  if (!turn.allFinite()) return 0;
  const double off = t.allFinite() ? turn.dot(t.normalized()) : turn.norm();
  const double variance = std::max(0.0, off * off - along(by_noise, t)) + std::max(0.0, along(covariance, t));
  return probability * variance / std::pow(std::cos(motion.angle), 2);
}

void KalmanHeightStage::doubtNormal(const Reconstruction& reconstruction,
                                    const ApproachAngleResult& approach) {
  doubtNormalByMotion(approach);
  const Eigen::Vector3d &n = approach.n, &p = approach.vanishing_direction;
  const bool leaps =
      vanishing_.leaps(approach.stamp, {p, approach.vanishing_covariance}, n, turnSince(approach));
  // One that contradicts by less has turned the normal itself.
  if (leaps && tests_.failed(Consistency::kVanishingPoint)) return;
  if (!reconstruction.alone.valid() || !p.allFinite()) return;
  doubt_.add(approach.stamp, tests_.result(Consistency::kVanishingPoint).ratio,
             (n - n.dot(p) * p).normalized() - n, n.dot(approach.vanishing_covariance * n),
             tests_.result(Consistency::kTilt).ratio > AttitudeFilter::kDoubtful);
}

void KalmanHeightStage::doubtNormalByMotion(const ApproachAngleResult& approach) {
  const ApproachAngleResult::Motion& motion = publishedMotion(approach);
  if (motion.failure || !motion.normal.allFinite()) return;
  const Eigen::Vector3d turn = motion.normal - approach.n;
  const Eigen::Matrix<double, 3, 2> across = tangents(approach.n);
  const Eigen::Matrix2d covariance =
      across.transpose() * (motion.normal_covariance + approach.n_covariance) * across;
  const Eigen::Vector2d off = across.transpose() * turn;
  motion_doubt_.add(approach.stamp, off.dot(covariance.ldlt().solve(off)), turn,
                    along(motion.normal_covariance, motion.translation_over_height),
                    tests_.result(Consistency::kTilt).ratio > AttitudeFilter::kDoubtful);
}

std::vector<KalmanHeightStage::OtherNormal> KalmanHeightStage::otherNormals(
    const Reconstruction& reconstruction, const ApproachAngleResult& approach,
    const GroundNormal& used) const {
  std::vector<OtherNormal> normals;
  const GroundPlane& plane = reconstruction.plane;
  const GroundNormal& average = reconstruction.normal;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  // approach_angle knows nothing of the rig's rotation, nor of how well that is known.
  if (!reconstruction.tilted && parameters_.rig_watch && plane.valid())
    normals.push_back({plane.normal(), plane.normalCovariance() - used.covariance, none, 1});
  // Nor of the pairs before: a plane that turns against them within what a test allows is one of two.
  if (plane.valid())
    normals.push_back({average.n, none,
                       reconstruction.tilted ? none : kCertain * (average.covariance + used.covariance), 1});
  // Of a plane and a vanishing point that contradict each other either may be right.
  const double doubt = doubt_.probability(approach.stamp);
  if (doubt > 0) {
    const Eigen::Matrix3d by_vanishing_point = doubt_.variance() * Eigen::Matrix3d::Identity();
    normals.push_back({approach.n + doubt_.turn(), by_vanishing_point, none, doubt});
    if (reconstruction.alone.valid()) normals.push_back({reconstruction.alone.normal(), none, none, doubt});
  }
  const double by_motion = motion_doubt_.probability(approach.stamp);
  // Which of both the angle's matches have followed is not known: all of the difference counts.
  if (by_motion > 0)
    normals.push_back({used.n + motion_doubt_.turn(), motion_doubt_.variance() * Eigen::Matrix3d::Identity(),
                       none, by_motion});
  return normals;
}

double KalmanHeightStage::varianceByNormals(const Reconstruction& reconstruction,
                                            const ApproachAngleResult& approach,
                                            const ApproachAngleResult::Motion& motion) const {
  const GroundNormal used = normalOfAngle(approach, motion);
  double variance = 0;
  for (const OtherNormal& other : otherNormals(reconstruction, approach, used))
    variance = std::max(variance, other.angleVariance(used.n, motion));
  return variance;
}

Eigen::Matrix3d KalmanHeightStage::doubtOfVelocity(const Eigen::Vector3d& velocity, double depth_change,
                                                   const ApproachAngleResult& approach,
                                                   const Reconstruction& reconstruction) const {
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();
  // After a gap an aircraft may have become that fast, but a wrong step is as likely.
  if (tests_.result(Consistency::kVelocity).ratio > AttitudeFilter::kDoubtful)
    doubt += reconstruction.velocity_change * reconstruction.velocity_change.transpose();
  doubt += depth_change * depth_change * velocity * velocity.transpose();
  // The vertical part is as uncertain as the angle by another normal.
  const Eigen::Vector3d n = normalOfAngle(approach, approach.step).n;
  if (n.allFinite())
    doubt += velocity.squaredNorm() * varianceByNormals(reconstruction, approach, approach.step) * n *
             n.transpose();
  return doubt;
}

void KalmanHeightStage::reportMotion(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                                     const Reconstruction& reconstruction, LandingResult& result) const {
  // A step that the velocity before contradicts may be of another period of a pattern, or of the other
  // camera; before three have agreed, and in an unusual turn, nobody can tell.
  const TestResult& compared = tests_.result(Consistency::kVelocity);
  const bool agrees = !parameters_.integrity_monitor || (compared.possible() && !compared.failed());
  if (reconstruction.refused || reconstruction.tilted || !agrees) return;
  // Its lengths are by the depths of a normal that knows nothing of the rig's rotation.
  const bool another = reconstruction.plane.valid() && approach.n.allFinite();
  const double change =
      another ? depthChange(rig_, stereo.points, approach.n, reconstruction.plane.normal()) : 0;
  const CameraTwist twist = cameraTwist(approach.step, (1 + change) * (result.height - reconstruction.bend),
                                        result.height_variance, stamps_.ofDuration());
  result.velocity = twist.velocity;
  result.angular_velocity = twist.angular_velocity;
  result.twist_covariance = twist.covariance;
  result.twist_covariance.topLeftCorner<3, 3>() +=
      doubtOfVelocity(twist.velocity, change, approach, reconstruction);
}

// jump: why the stamp says nothing of the time since the pair before, if so.
void KalmanHeightStage::reportAngle(const ApproachAngleResult& approach, const Reconstruction& reconstruction,
                                    const Failure& jump, LandingResult& result) const {
  const ApproachAngleResult::Motion& motion = publishedMotion(approach);
  result.raw_approach_angle = approach.step.angle;
  result.raw_approach_angle_variance =
      approach.step.angle_variance + varianceByNormals(reconstruction, approach, approach.step);
  result.foe = approach.foe;
  result.approach_angle = motion.angle;
  result.approach_angle_variance =
      motion.angle_variance + varianceByNormals(reconstruction, approach, motion);
  // The path has a step in it for as long as the window is.
  if (velocity_.sinceContradiction() < window_) result.approach_angle_variance += path_doubt_ * path_doubt_;
  if (tests_.failed(Consistency::kVelocity)) result.raw_approach_angle_variance += path_doubt_ * path_doubt_;

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
    failure = {Reason::kUncertain, text("approach angle has 1 sigma of ", rounded(stddev / kDegree),
                                        " deg, more than ", parameters_.max_angle_stddev_deg, " deg")};
  result.angle_valid = !failure;
  if (!result.failure) result.failure = failure;
}

}  // namespace uav_landing
