#include "landing/watch/path_doubt.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "results/any_angle.h"

namespace uav_landing {
namespace {

// Limit of the squared normalised error that noise alone exceeds in 5 % of the cases.
const double kCertain = chiSquareLimit(0.05, 1);

double along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& t) {
  return t.allFinite() ? t.dot(covariance * t) / t.squaredNorm() : covariance.trace();
}

/// Whether the plane has turned against the previous pairs, so that they say nothing about it.
bool hasTurned(const PairTests& tests) {
  return tests.result(IntegrityTest::kTilt).ratio > AttitudeFilter::kDoubtful.squared();
}

}  // namespace

std::optional<GroundNormal> normalOfAngle(const ApproachAngleResult& approach,
                                          const ApproachAngleResult::Motion& motion) {
  const std::optional<GroundNormal> given = GroundNormal::of(approach.n, approach.n_covariance);
  const std::optional<GroundNormal> own = GroundNormal::of(motion.normal, motion.normal_covariance);
  return given && own ? weightedMean(*given, *own) : given;
}

PathDoubt::PathDoubt(const KalmanHeightParameters& parameters)
    : rig_watch_(parameters.rig_watch),
      by_vanishing_point_(parameters.fault_probability, parameters.reset_timeout),
      by_motion_(parameters.fault_probability, parameters.reset_timeout) {}

double PathDoubt::variance(const PairInput& in, const Ground& ground,
                           const ApproachAngleResult::Motion& motion) const {
  if (motion.rowsMove()) return kAnyAngle * kAnyAngle;
  const std::optional<GroundNormal> used = normalOfAngle(in.approach, motion);
  if (!used) return 0;
  double variance = 0;
  for (const OtherNormal& other : otherNormals(in, ground, *used))
    variance = std::max(variance, other.angleVariance(used->vector(), motion));
  return variance;
}

// Variance of an angle that was measured against the normal `used`, if the ground has the other one. The
// matches may or may not have compensated for the difference. So its part along the direction of motion
// counts as 1 sigma.
double PathDoubt::OtherNormal::angleVariance(const Eigen::Vector3d& used,
                                             const ApproachAngleResult::Motion& motion) const {
  const Eigen::Vector3d turn = normal - used, &t = motion.translation_over_height;
  if (!turn.allFinite()) return 0;
  const double off = t.allFinite() ? turn.dot(t.normalized()) : turn.norm();
  const double variance = std::max(0.0, off * off - along(by_noise, t)) + std::max(0.0, along(covariance, t));
  return probability * variance / std::pow(std::cos(motion.angle), 2);
}

std::vector<PathDoubt::OtherNormal> PathDoubt::otherNormals(const PairInput& in, const Ground& ground,
                                                            const GroundNormal& used) const {
  std::vector<OtherNormal> normals;
  const GroundPlane& plane = ground.plane;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  // The stage approach_angle does not know the rig's rotation, nor how uncertain that is.
  if (!ground.tilted && rig_watch_ && plane.valid())
    normals.push_back({plane.normal(), plane.normalCovariance() - used.covariance(), none, 1});
  // It does not know the previous pairs either. If the plane turned against them within the limit of a test,
  // either may be right.
  if (ground.normal)
    normals.push_back({ground.normal->vector(), none,
                       ground.tilted ? none : kCertain * (ground.normal->covariance() + used.covariance()),
                       1});
  // If a plane and a vanishing point contradict each other, either may be right.
  const double doubt = by_vanishing_point_.probability(in.approach.stamp);
  if (doubt > 0) {
    const Eigen::Matrix3d covariance = by_vanishing_point_.variance() * Eigen::Matrix3d::Identity();
    normals.push_back({in.approach.n + by_vanishing_point_.turn(), covariance, none, doubt});
    if (ground.alone.valid()) normals.push_back({ground.alone.normal(), none, none, doubt});
  }
  const double by_motion = by_motion_.probability(in.approach.stamp);
  // It is not known which of both normals the angle's matches followed, so the whole difference counts.
  if (by_motion > 0)
    normals.push_back({used.vector() + by_motion_.turn(), by_motion_.variance() * Eigen::Matrix3d::Identity(),
                       none, by_motion});
  return normals;
}

void PathDoubt::update(const PairInput& in, const Ground& ground, const PairTests& tests) {
  updateByMotion(in, tests);
  updateByVanishingPoint(in, ground, tests);
}

void PathDoubt::updateByVanishingPoint(const PairInput& in, const Ground& ground, const PairTests& tests) {
  const ApproachAngleResult& approach = in.approach;
  const Eigen::Vector3d &n = approach.n, &p = approach.vanishing_direction;
  const bool leaps = vanishing_.leaps(in.approach.stamp, {p, approach.vanishing_covariance}, n, in.turn);
  // A jump that fails the test is no evidence. A smaller one is, because such a vanishing point has turned
  // the normal itself.
  if (leaps && tests.failed(IntegrityTest::kVanishingPoint)) return;
  if (!ground.alone.valid() || !p.allFinite()) return;
  by_vanishing_point_.add(in.approach.stamp, tests.result(IntegrityTest::kVanishingPoint).ratio,
                          (n - n.dot(p) * p).normalized() - n, n.dot(approach.vanishing_covariance * n),
                          hasTurned(tests));
}

void PathDoubt::updateByMotion(const PairInput& in, const PairTests& tests) {
  const ApproachAngleResult::Motion& motion = in.path();
  const ApproachAngleResult& approach = in.approach;
  if (motion.failure || !motion.normal.allFinite()) return;
  const Eigen::Vector3d turn = motion.normal - approach.n;
  const Eigen::Matrix<double, 3, 2> across = tangents(approach.n);
  const Eigen::Matrix2d covariance =
      across.transpose() * (motion.normal_covariance + approach.n_covariance) * across;
  const Eigen::Vector2d off = across.transpose() * turn;
  by_motion_.add(in.approach.stamp, off.dot(covariance.ldlt().solve(off)), turn,
                 along(motion.normal_covariance, motion.translation_over_height), hasTurned(tests));
}

}  // namespace uav_landing
