#include "lines/vanishing/vanishing_lines.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/limits.h"

namespace uav_landing {

namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kPriorTolerance = 5 * kDegree;  // of a direction against the ground known from elsewhere
constexpr Sigmas kGate(4);                       // of a line's own errors
constexpr double kStraightness = 1.0;            // px by which an edge may differ from a straight line

}  // namespace

VanishingLines::VanishingLines(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                               const ApproachAngleParameters& parameters, const Eigen::Vector3d* prior_normal)
    : lines_(lines.begin(), lines.end()),
      K_(K),
      Kinv_(K.inverse()),
      parameters_(parameters),
      prior_normal_(prior_normal) {
  const Eigen::Vector3d horizon =
      prior_normal ? Eigen::Vector3d(Kinv_.transpose() * *prior_normal) : Eigen::Vector3d::UnitY();
  horizon_ = Eigen::Vector2d(horizon.y(), -horizon.x()).normalized();
}

bool VanishingLines::alongRunway(const Eigen::Vector3d& v) const {
  return std::abs(std::atan2(v.x(), v.z())) <= parameters_.max_yaw_deg * kDegree &&
         std::abs(std::asin(v.y())) <= parameters_.max_elevation_deg * kDegree &&
         (prior_normal_ == nullptr || std::abs(prior_normal_->dot(v)) <= std::sin(kPriorTolerance));
}

bool VanishingLines::meeting(int i, int j, Eigen::Vector3d& direction) const {
  direction = Kinv_ * (*this)[i].line.cross((*this)[j].line);
  const double norm = direction.norm();
  if (!(norm > 0)) return false;
  direction *= (direction.z() < 0 ? -1 : 1) / norm;
  return alongRunway(direction);
}

double VanishingLines::toleranceOf(const VanishingCandidate& line) const {
  return std::min(std::max(kStraightness, kGate.bound(line.endVariance())), parameters_.ransac_tolerance);
}

std::vector<int> VanishingLines::passing(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d V = K_ * direction;
  std::vector<int> indices;
  indices.reserve(lines_.size());
  for (int i = 0; i < count(); ++i) {
    const VanishingCandidate& line = (*this)[i];
    if (line.endMiss2(V) <= std::pow(toleranceOf(line), 2) && !line.isAboveHorizon(V)) indices.push_back(i);
  }
  return indices;
}

double VanishingLines::perTurn(const VanishingCandidate& line) const {
  const double sine = std::abs(line.along.x() * horizon_.y() - line.along.y() * horizon_.x());
  return 1 / (K_(0, 0) * std::max(sine, 1e-6));
}

}  // namespace uav_landing
