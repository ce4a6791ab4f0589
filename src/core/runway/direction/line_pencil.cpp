#include "runway/direction/line_pencil.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lines/segments/heading_gate.h"
#include "lines/vanishing/vanishing_chance.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kLeastCrossing = 3 * kDegree;  // least angle between two lines in the image
constexpr double kAcross = 12 * kDegree;        // largest angle to the horizon in the image
constexpr double kLeastChance = 1e-4;           // limit, so that no single line says more than this

Eigen::Vector2d directionOf(const Eigen::Vector3d& line) {
  return Eigen::Vector2d(line.y(), -line.x()).normalized();
}

}  // namespace

GroundLines::GroundLines(const VanishingLines& lines, const Eigen::Vector3d& normal)
    : lines_(lines), normal_(normal) {
  const Eigen::Matrix3d Kinv = lines.K().inverse();
  const HeadingGate gate(lines.K(), normal, lines.parameters().max_yaw_deg * kDegree);
  const Eigen::Vector2d horizon = directionOf(Kinv.transpose() * normal);
  for (const VanishingCandidate& line : lines.all()) {
    const Eigen::Vector2d half = line.half * line.along;
    rays_.push_back({Kinv * (line.middle - half).homogeneous(), Kinv * (line.middle + half).homogeneous(),
                     Kinv * line.middle.homogeneous()});
    ahead_.push_back(gate.passes(line.line) ? 1 : 0);
    across_.push_back(std::abs(line.along.dot(horizon)) > std::cos(kAcross) ? 1 : 0);
  }
}

std::optional<Eigen::Vector3d> GroundLines::meeting(int i, int j) const {
  const Eigen::Vector2d &p = lines_[i].along, &q = lines_[j].along;
  if (std::abs(p.x() * q.y() - p.y() * q.x()) < std::sin(kLeastCrossing)) return std::nullopt;
  Eigen::Vector3d direction;
  if (!lines_.meeting(i, j, direction)) return std::nullopt;
  return direction;
}

GroundAxes GroundLines::axesAlong(const Eigen::Vector3d& direction) const {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
  return {(normal_ - normal_.dot(direction) * direction).normalized(), none, direction, none};
}

std::optional<LinePlace> GroundLines::place(const GroundAxes& axes, int i) const {
  const Rays& rays = rays_[static_cast<size_t>(i)];
  if (std::min(axes.down.dot(rays.a), axes.down.dot(rays.b)) < GroundAxes::kLeastSlope) return std::nullopt;
  const double a = axes.meet(rays.a).x(), b = axes.meet(rays.b).x();
  return LinePlace{axes.meet(rays.middle).y(), std::min(a, b), std::max(a, b)};
}

LinePencil GroundLines::pencil(const GroundAxes& axes) const {
  const auto count = static_cast<size_t>(lines_.count());
  LinePencil pencil{{}, std::vector<char>(count, 0), std::vector<double>(count, 0)};
  pencil.places.reserve(count);
  for (int i = 0; i < lines_.count(); ++i) pencil.places.push_back(place(axes, i));
  const Eigen::Vector3d V = lines_.K() * axes.forward;
  for (const int i : lines_.passing(axes.forward)) {
    const auto k = static_cast<size_t>(i);
    if (!pencil.places[k] || !isAhead(i)) continue;
    const VanishingCandidate& line = lines_[i];
    const double chance = std::clamp(chanceOfPassing(lines_, line, V), kLeastChance, 1.0);
    pencil.passes[k] = 1;
    pencil.evidence[k] = evidenceOf(chance) * (1 - line.endMiss2(V) / std::pow(lines_.toleranceOf(line), 2));
  }
  return pencil;
}

}  // namespace uav_landing
