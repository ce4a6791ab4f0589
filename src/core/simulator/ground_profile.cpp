#include "simulator/ground_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

constexpr double kRadiansPerDegree = M_PI / 180;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

GroundProfile::GroundProfile(const SimulatedProfileParameters& p)
    : flat_(p.slope_before_deg == 0 && p.slope_after_deg == 0) {
  const double before = std::tan(p.slope_before_deg * kRadiansPerDegree);
  const double after = std::tan(p.slope_after_deg * kRadiansPerDegree);
  const double start = p.change_start, end = p.change_start + p.change_length;
  const double curvature = p.change_length > 0 ? (after - before) / p.change_length : 0;
  pieces_[0] = {-kInfinity, start, start, 0, before, 0};
  pieces_[1] = {start, end, start, 0, before, curvature};
  pieces_[2] = {end, kInfinity, end, pieces_[1].at(end), after, 0};
  const double threshold = height(0);
  for (Piece& piece : pieces_) piece.height -= threshold;
}

double GroundProfile::Piece::at(double x) const {
  const double way = x - from;
  return height + way * (slope + 0.5 * curvature * way);
}

GroundProfile::Line GroundProfile::Piece::tangent(double x) const {
  const double here = slope + curvature * (x - from);
  return {here, at(x) - here * x};
}

double GroundProfile::Piece::meet(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction) const {
  // Height of the ray over the piece after s: a + b s - c s^2.
  const double x = centre.x() - from, dx = direction.x();
  const double a = centre.z() - at(centre.x());
  const double b = direction.z() - (slope + curvature * x) * dx;
  const double c = 0.5 * curvature * dx * dx;
  const double root = std::sqrt(std::max(b * b + 4 * a * c, 0.0));
  double nearest = kInfinity;
  // Both solutions in the form that loses no digits when c is small or 0.
  const double q = 0.5 * (b + std::copysign(root, b));
  for (const double s : {c != 0 ? q / c : kInfinity, q != 0 ? -a / q : kInfinity}) {
    const double met = centre.x() + s * dx;
    const bool real = b * b + 4 * a * c >= 0;
    if (real && s > 0 && std::isfinite(s) && met >= begin && met <= end) nearest = std::min(nearest, s);
  }
  return nearest;
}

const GroundProfile::Piece& GroundProfile::pieceAt(double x) const {
  return x < pieces_[1].begin ? pieces_[0] : x < pieces_[1].end ? pieces_[1] : pieces_[2];
}

double GroundProfile::height(double x) const { return pieceAt(x).at(x); }

GroundProfile::Line GroundProfile::seen(const Eigen::Vector3d& centre,
                                        const Eigen::Vector3d& direction) const {
  double nearest = kInfinity;
  const Piece* met = nullptr;
  for (const Piece& piece : pieces_) {
    const double s = piece.meet(centre, direction);
    if (s >= nearest) continue;
    nearest = s;
    met = &piece;
  }
  if (met != nullptr) return met->tangent(centre.x() + nearest * direction.x());
  const Piece& far = direction.x() >= 0 ? pieces_[2] : pieces_[0];
  return far.tangent(far.from);
}

}  // namespace uav_landing
