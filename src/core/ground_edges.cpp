#include "uav_landing/ground_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

constexpr double kSameEdge = 3;            // sigma between measurements of one edge
constexpr double kLeastTolerance = 0.003;  // of the distance from the camera to the edge, in the same
constexpr double kLeastSlope = 1e-3;       // n.r of the horizon's neighbourhood, where nothing is measured

double distanceOf(double lateral) { return std::hypot(1.0, lateral); }

bool isSame(const GroundEdge& a, const GroundEdge& b, double more_variance) {
  const double tolerance = kSameEdge * std::sqrt(a.variance + b.variance + more_variance) +
                           kLeastTolerance * distanceOf(a.lateral);
  return a.brighter_left == b.brighter_left && std::abs(a.lateral - b.lateral) <= tolerance;
}

/// Both measurements of one edge, weighted by their variances. The places from where to where it is seen are
/// left as they are in a.
GroundEdge mean(const GroundEdge& a, const GroundEdge& b) {
  GroundEdge edge = a;
  const double weight = a.variance / (a.variance + b.variance);
  edge.lateral += weight * (b.lateral - a.lateral);
  edge.by_rotation += weight * (b.by_rotation - a.by_rotation);
  edge.variance = a.variance * b.variance / (a.variance + b.variance);
  return edge;
}

void addPiece(std::vector<GroundEdge>& edges, const GroundEdge& piece) {
  const auto same =
      std::find_if(edges.begin(), edges.end(), [&](const GroundEdge& e) { return isSame(e, piece, 0); });
  if (same == edges.end()) {
    edges.push_back(piece);
    return;
  }
  *same = mean(*same, piece);
  same->near = std::min(same->near, piece.near);
  same->far = std::max(same->far, piece.far);
  same->extent = std::min(same->extent + piece.extent, std::log(same->far / same->near));
}

}  // namespace

GroundAxes::GroundAxes(const Eigen::Vector3d& normal, const Eigen::Matrix3d& normal_covariance,
                       const Eigen::Vector3d& direction, const Eigen::Matrix3d& direction_covariance)
    : down(normal), forward((direction - normal.dot(direction) * normal).normalized()) {
  left = forward.cross(down);
  // A rotation about forward tips the normal towards left, one about left towards -forward.
  Eigen::Matrix<double, 2, 3> tips;
  tips << left.transpose(), -forward.transpose();
  covariance.setZero();
  covariance.topLeftCorner<2, 2>() = tips * normal_covariance * tips.transpose();
  covariance(2, 2) = left.dot(direction_covariance * left);
}

Eigen::Vector2d GroundAxes::meet(const Eigen::Vector3d& ray) const {
  return Eigen::Vector2d(forward.dot(ray), left.dot(ray)) / down.dot(ray);
}

Eigen::Matrix<double, 2, 3> GroundAxes::meetByRotation(const Eigen::Vector2d& point) {
  // An axis a turns by w x a. With the ray to the point, r = x forward + y left + down:
  // d(forward.r) = w_left - w_down y, d(left.r) = w_down x - w_forward, d(down.r) = w_forward y - w_left x.
  const double x = point.x(), y = point.y();
  Eigen::Matrix<double, 2, 3> derivatives;
  derivatives << -x * y, 1 + x * x, -y, -1 - y * y, x * y, x;
  return derivatives;
}

std::vector<GroundEdge> groundEdges(const StereoRig& rig, const GroundAxes& axes,
                                    const std::vector<LineSegment>& lines, const std::vector<char>& along,
                                    double cx, double baseline) {
  // The right camera is lower when the rig is rolled, and stands to the right.
  const double height = 1 - baseline * axes.down.x();
  const double lateral = baseline * axes.left.x();
  const auto ray = [&](const Eigen::Vector2d& pixel) {
    return Eigen::Vector3d((pixel.x() - cx) / rig.fx, (pixel.y() - rig.cy) / rig.fy, 1);
  };
  std::vector<GroundEdge> pieces;
  for (size_t i = 0; i < lines.size(); ++i) {
    const LineSegment& line = lines[i];
    if (along[i] == 0) continue;
    if (std::min(axes.down.dot(ray(line.a)), axes.down.dot(ray(line.b))) < kLeastSlope) continue;
    const double a = axes.meet(ray(line.a)).x() * height, b = axes.meet(ray(line.b)).x() * height;
    GroundEdge edge;
    edge.near = std::min(a, b);
    edge.far = std::max(a, b);
    if (edge.near <= 0) continue;
    edge.extent = std::log(edge.far / edge.near);
    const Eigen::Vector2d middle = line.middle(), across = line.line.head<2>();
    const Eigen::Vector2d point = axes.meet(ray(middle));
    const double by_offset =
        0.5 * height * (axes.meet(ray(middle + across)).y() - axes.meet(ray(middle - across)).y());
    edge.lateral = point.y() * height + lateral;
    edge.variance = std::pow(by_offset * line.offset_stddev, 2);
    edge.by_rotation = height * GroundAxes::meetByRotation(point).row(1).transpose();
    edge.brighter_left = by_offset > 0;
    pieces.push_back(edge);
  }
  const auto longer = [](const GroundEdge& l, const GroundEdge& r) { return l.extent > r.extent; };
  std::sort(pieces.begin(), pieces.end(), longer);
  std::vector<GroundEdge> edges;
  for (const GroundEdge& piece : pieces) addPiece(edges, piece);
  std::sort(edges.begin(), edges.end(), longer);
  return edges;
}

std::vector<GroundEdge> matchEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                   const std::vector<GroundEdge>& right) {
  std::vector<GroundEdge> matched;
  std::vector<char> taken(right.size(), 0);
  for (const GroundEdge& edge : left) {
    int nearest = -1;
    for (size_t i = 0; i < right.size(); ++i) {
      const Eigen::Vector3d differ = edge.by_rotation - right[i].by_rotation;
      if (taken[i] != 0 || !isSame(edge, right[i], differ.dot(axes.covariance * differ))) continue;
      if (nearest < 0 ||
          std::abs(right[i].lateral - edge.lateral) < std::abs(right[nearest].lateral - edge.lateral))
        nearest = static_cast<int>(i);
    }
    if (nearest < 0) continue;
    taken[nearest] = 1;
    matched.push_back(mean(edge, right[nearest]));
  }
  return matched;
}

}  // namespace uav_landing
