#include "simulator/ground/ground_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uav_landing {
namespace {

constexpr double kRadiansPerDegree = M_PI / 180;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A slope that changes at a steady rate to another one.
struct SlopeChange {
  double start, end, before, after;
  double curvature() const { return end > start ? (after - before) / (end - start) : 0; }
};

}  // namespace

GroundProfile::GroundProfile(const SimulatedProfileParameters& p)
    : flat_(p.slope_before_deg == 0 && p.slope_after_deg == 0 && p.hill_height == 0) {
  std::vector<SlopeChange> changes{{p.change_start, p.change_start + p.change_length,
                                    std::tan(p.slope_before_deg * kRadiansPerDegree),
                                    std::tan(p.slope_after_deg * kRadiansPerDegree)}};
  if (p.hill_height > 0) {
    // The hill rises over two quarters of its length. The slope grows over the first one and returns to 0
    // over the second one.
    const double quarter = 0.25 * p.hill_length, steepest = p.hill_height / quarter;
    const double foot = p.hill_x - 2 * quarter;
    changes.push_back({foot, foot + quarter, 0, steepest});
    changes.push_back({foot + quarter, foot + 3 * quarter, 0, -2 * steepest});
    changes.push_back({foot + 3 * quarter, foot + 4 * quarter, 0, steepest});
  }
  std::vector<double> borders;
  for (const SlopeChange& change : changes) borders.insert(borders.end(), {change.start, change.end});
  std::sort(borders.begin(), borders.end());
  pieces_.push_back({-kInfinity, borders.front(), borders.front(), 0, changes.front().before, 0});
  for (size_t i = 0; i < borders.size(); ++i) {
    const double from = borders[i], to = i + 1 < borders.size() ? borders[i + 1] : kInfinity;
    Piece piece{from, to, from, pieces_.back().at(from), 0, 0};
    for (const SlopeChange& change : changes) {
      const bool under_way = from >= change.start && from < change.end;
      piece.slope += from >= change.end ? change.after
                     : under_way        ? change.before + change.curvature() * (from - change.start)
                                        : change.before;
      if (under_way) piece.curvature += change.curvature();
    }
    pieces_.push_back(piece);
  }
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
  // Height of the ray above the piece at s: a + b s - c s^2.
  const double x = centre.x() - from, dx = direction.x();
  const double a = centre.z() - at(centre.x());
  const double b = direction.z() - (slope + curvature * x) * dx;
  const double c = 0.5 * curvature * dx * dx;
  const double root = std::sqrt(std::max(b * b + 4 * a * c, 0.0));
  double nearest = kInfinity;
  // This form of both solutions loses no digits when c is small or 0.
  const double q = 0.5 * (b + std::copysign(root, b));
  for (const double s : {c != 0 ? q / c : kInfinity, q != 0 ? -a / q : kInfinity}) {
    const double met = centre.x() + s * dx;
    const bool real = b * b + 4 * a * c >= 0;
    if (real && s > 0 && std::isfinite(s) && met >= begin && met <= end) nearest = std::min(nearest, s);
  }
  return nearest;
}

const GroundProfile::Piece& GroundProfile::pieceAt(double x) const {
  return *std::find_if(pieces_.begin(), pieces_.end() - 1, [x](const Piece& piece) { return x < piece.end; });
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
  const Piece& far = direction.x() >= 0 ? pieces_.back() : pieces_.front();
  return far.tangent(far.from);
}

}  // namespace uav_landing
