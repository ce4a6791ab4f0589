#include "lines/vanishing/vanishing_point.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "geometry/rotation.h"
#include "lines/vanishing/vanishing_candidate.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kViewsDiffer = 1 * kDegree;  // with kViewsGate: left and right saw different things
constexpr double kViewsGate = 25;             // squared, 2 degrees of freedom

using Matrix32 = Eigen::Matrix<double, 3, 2>;

Expected<VanishingPoint> fuseViews(const VanishingPoint& left, const VanishingPoint& right) {
  const Matrix32 B = tangents(left.direction);
  const Eigen::Vector2d difference = B.transpose() * (right.direction - left.direction);
  const Eigen::Matrix2d Cl = B.transpose() * left.covariance * B, Cr = B.transpose() * right.covariance * B;
  const Eigen::Matrix2d Sinv = (Cl + Cr).inverse();
  const double nis = difference.dot(Sinv * difference);
  if (nis > kViewsGate && difference.norm() > kViewsDiffer)
    return tl::unexpected(Failure{
        Reason::kNoVanishingPoint,
        text("left and right differ by ", std::round(10 * difference.norm() / kDegree) / 10, " deg")});
  const Eigen::Matrix2d gain = Cl * Sinv;
  VanishingPoint mean;
  mean.direction = (left.direction + B * (gain * difference)).normalized();
  // When views differ by more than they claim, their claims were too small.
  const Matrix32 T = tangents(mean.direction);
  const Eigen::Matrix2d covariance = std::max(1.0, nis / 2) * gain * Cr;
  const Eigen::Matrix2d turn = T.transpose() * B;
  mean.covariance = T * turn * covariance * turn.transpose() * T.transpose();
  mean.inlier_count = left.inlier_count + right.inlier_count;
  // Both views see mostly the same lines. So the margins do not add up, and the larger one is not better.
  mean.runway_margin = 0.5 * (left.runway_margin + right.runway_margin);
  return mean;
}

}  // namespace

Expected<VanishingPoint> combineVanishingPoints(const Expected<VanishingPoint>& left,
                                                const Expected<VanishingPoint>& right,
                                                double runway_straightness) {
  if (!left && !right)
    return tl::unexpected(
        Failure{left.error().reason, "left: " + left.error().detail + "; right: " + right.error().detail});
  Expected<VanishingPoint> mean = left && right ? fuseViews(*left, *right) : left ? left : right;
  if (!mean) return mean;
  mean->inliers.clear();
  const Eigen::Vector3d& p = mean->direction;
  mean->covariance +=
      runway_straightness * runway_straightness * (Eigen::Matrix3d::Identity() - p * p.transpose());
  return mean;
}

std::optional<GroundNormal> normalFromVanishingPoint(const VanishingPoint& point, double roll,
                                                     double roll_stddev) {
  // The horizon's direction w = (cos, -sin, 0) lies in the ground, as p does. So n = p x w, and rollOf(n) is
  // exactly the roll.
  const Eigen::Vector3d& p = point.direction;
  const Eigen::Vector3d w(std::cos(roll), -std::sin(roll), 0), dw(-std::sin(roll), -std::cos(roll), 0);
  const Eigen::Vector3d m = p.cross(w);
  const Eigen::Vector3d normal = m.normalized();
  const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - normal * normal.transpose()) / m.norm();
  Eigen::Matrix3d minus_w_cross;
  minus_w_cross << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
  const Eigen::Matrix3d from_point = across * minus_w_cross;
  const Eigen::Vector3d from_roll = across * p.cross(dw);
  const Eigen::Matrix3d covariance = from_point * point.covariance * from_point.transpose() +
                                     roll_stddev * roll_stddev * from_roll * from_roll.transpose();
  return GroundNormal::of(normal, covariance);
}

}  // namespace uav_landing
