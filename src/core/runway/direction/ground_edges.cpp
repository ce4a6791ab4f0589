#include "runway/direction/ground_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace uav_landing {
namespace {

constexpr double kSameEdge = 3;  // standard deviations between measurements of one edge
// Least tolerance as a share of the distance from the camera to the edge.
constexpr double kLeastTolerance = 0.003;
constexpr double kBorder = 16;  // px from the image's border
constexpr double kAlong = 3;    // standard deviations between the direction of a line and that of the runway
constexpr double kStraight = 0.5;  // px, 1 sigma by which an edge in the image is not straight

double distanceOf(double lateral) { return std::sqrt(1 + lateral * lateral); }

bool isSame(const GroundAxes& axes, const GroundEdge& a, const GroundEdge& b) {
  if (a.brighter_left != b.brighter_left) return false;
  const Eigen::Vector3d differ = a.by_rotation - b.by_rotation;
  const double variance = a.variance + b.variance + differ.dot(axes.covariance * differ);
  const double tolerance = kSameEdge * std::sqrt(variance) + kLeastTolerance * distanceOf(a.lateral);
  return std::abs(a.lateral - b.lateral) <= tolerance;
}

/// The lines of one view on the ground.
class View {
 public:
  View(const StereoRig& rig, const GroundAxes& axes, const ViewCamera& camera)
      : rig_(rig),
        axes_(axes),
        cx_(camera.cx),
        // The right camera stands to the right. When the rig is rolled, it is also lower or higher.
        height_(1 - camera.baseline * axes.down.x()),
        place_(camera.baseline * axes.forward.x(), camera.baseline * axes.left.x()) {}

  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx_) / rig_.fx, (pixel.y() - rig_.cy) / rig_.fy, 1};
  }
  /// Nearest and farthest end, forward of the left camera. Nothing when the line reaches the horizon or lies
  /// behind the camera.
  std::optional<std::pair<double, double>> ends(const LineSegment& line) const {
    const Eigen::Vector3d a = ray(line.a), b = ray(line.b);
    if (std::min(axes_.down.dot(a), axes_.down.dot(b)) < GroundAxes::kLeastSlope) return std::nullopt;
    const double at_a = onGround(a).x(), at_b = onGround(b).x();
    if (std::min(at_a, at_b) <= 0) return std::nullopt;
    return std::minmax(at_a, at_b);
  }
  /// Whether the near end of the line is away from the image's border.
  bool beginsInside(const LineSegment& line) const {
    const Eigen::Vector3d a = ray(line.a), b = ray(line.b);
    const Eigen::Vector2d& end = onGround(a).x() < onGround(b).x() ? line.a : line.b;
    return std::min(end.x(), end.y()) > kBorder && end.x() < rig_.size.width - kBorder &&
           end.y() < rig_.size.height - kBorder;
  }
  EdgePiece piece(const LineSegment& line) const {
    EdgePiece piece;
    const Eigen::Vector2d middle = line.middle();
    piece.forward = onGround(ray(middle)).x();
    const Eigen::Vector2d here = lateralAndSlope(line.line, piece.forward);
    piece.lateral = here[0];
    piece.slope = here[1];
    const Eigen::Vector2d across = line.line.head<2>(), along(-across.y(), across.x());
    const Eigen::Vector2d turned = (across + line.angle_stddev * along).normalized();
    const Eigen::Vector3d moved = line.line - Eigen::Vector3d(0, 0, line.offset_stddev);
    const Eigen::Vector2d by_offset = lateralAndSlope(moved, piece.forward) - here;
    const Eigen::Vector2d by_angle =
        lateralAndSlope({turned.x(), turned.y(), -turned.dot(middle)}, piece.forward) - here;
    piece.covariance = by_offset * by_offset.transpose() + by_angle * by_angle.transpose();
    return piece;
  }
  bool brighterLeft(const LineSegment& line) const {
    const Eigen::Vector2d middle = line.middle(), across = line.line.head<2>();
    return onGround(ray(middle + across)).y() > onGround(ray(middle - across)).y();
  }
  /// Derivatives of the lateral position by rotations of the axes.
  Eigen::Vector3d byRotation(const EdgePiece& piece) const {
    const Eigen::Vector2d seen = (Eigen::Vector2d(piece.forward, piece.lateral) - place_) / height_;
    return height_ * GroundAxes::meetByRotation(seen).row(1).transpose();
  }

 private:
  Eigen::Vector2d onGround(const Eigen::Vector3d& ray) const { return height_ * axes_.meet(ray) + place_; }

  Eigen::Vector2d lateralAndSlope(const Eigen::Vector3d& line, double forward) const {
    // Normal of the plane through the camera and the line, in the ground's axes.
    const Eigen::Vector3d plane(line.x() * rig_.fx, line.y() * rig_.fy,
                                line.x() * cx_ + line.y() * rig_.cy + line.z());
    const double f = plane.dot(axes_.forward), l = plane.dot(axes_.left), d = plane.dot(axes_.down);
    return {-(f * (forward - place_.x()) + d * height_) / l + place_.y(), -f / l};
  }

  const StereoRig& rig_;
  const GroundAxes& axes_;
  double cx_, height_;
  Eigen::Vector2d place_;  // place of the camera, forward and left of the left one
};

/// Mean of two measurements of one edge, weighted by their variances. The ends are those of a.
GroundEdge mean(const GroundEdge& a, const GroundEdge& b) {
  GroundEdge edge = a;
  const double weight = a.variance / (a.variance + b.variance);
  edge.lateral += weight * (b.lateral - a.lateral);
  edge.by_rotation += weight * (b.by_rotation - a.by_rotation);
  edge.variance = a.variance * b.variance / (a.variance + b.variance);
  edge.pieces.insert(edge.pieces.end(), b.pieces.begin(), b.pieces.end());
  return edge;
}

/// Pairs of indices of the edges that both views see at the same place.
std::vector<std::pair<size_t, size_t>> sameEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                                 const std::vector<GroundEdge>& right) {
  std::vector<std::pair<size_t, size_t>> same;
  std::vector<char> taken(right.size(), 0);
  for (size_t l = 0; l < left.size(); ++l) {
    std::optional<size_t> nearest;
    const auto distance = [&](size_t r) { return std::abs(right[r].lateral - left[l].lateral); };
    for (size_t r = 0; r < right.size(); ++r) {
      if (taken[r] != 0 || !isSame(axes, left[l], right[r])) continue;
      if (!nearest || distance(r) < distance(*nearest)) nearest = r;
    }
    if (!nearest) continue;
    taken[*nearest] = 1;
    same.emplace_back(l, *nearest);
  }
  return same;
}

void addPiece(const GroundAxes& axes, std::vector<GroundEdge>& edges, const GroundEdge& piece) {
  const auto same = std::find_if(edges.begin(), edges.end(),
                                 [&](const GroundEdge& edge) { return isSame(axes, edge, piece); });
  if (same == edges.end()) {
    edges.push_back(piece);
    return;
  }
  *same = mean(*same, piece);
  if (piece.near < same->near) same->begins = piece.begins;
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

std::vector<char> linesAlong(const StereoRig& rig, const GroundAxes& axes,
                             const std::vector<LineSegment>& lines, double cx) {
  const View view(rig, axes, {cx});
  std::vector<char> along(lines.size(), 0);
  for (size_t i = 0; i < lines.size(); ++i) {
    if (!view.ends(lines[i])) continue;
    LineSegment line = lines[i];
    line.angle_stddev = std::hypot(line.angle_stddev, kStraight / line.length());
    const EdgePiece piece = view.piece(line);
    const Eigen::Vector2d by_rotation(piece.lateral, 1);  // of the slope, by rotations about left and down
    const double variance =
        piece.covariance(1, 1) + by_rotation.dot(axes.covariance.bottomRightCorner<2, 2>() * by_rotation);
    if (piece.slope * piece.slope <= kAlong * kAlong * variance) along[i] = 1;
  }
  return along;
}

std::vector<GroundEdge> groundEdges(const StereoRig& rig, const GroundAxes& axes,
                                    const std::vector<LineSegment>& lines, const std::vector<char>& along,
                                    const ViewCamera& camera) {
  const View view(rig, axes, camera);
  std::vector<GroundEdge> pieces;
  for (size_t i = 0; i < lines.size(); ++i) {
    const auto ends = along[i] != 0 ? view.ends(lines[i]) : std::nullopt;
    if (!ends) continue;
    GroundEdge edge;
    std::tie(edge.near, edge.far) = *ends;
    edge.extent = std::log(edge.far / edge.near);
    const EdgePiece piece = view.piece(lines[i]);
    edge.lateral = piece.lateral;
    edge.variance = piece.covariance(0, 0);
    edge.by_rotation = view.byRotation(piece);
    edge.brighter_left = view.brighterLeft(lines[i]);
    edge.pieces = {piece};
    edge.pixel = 1 / rig.fx;
    edge.begins = view.beginsInside(lines[i]);
    pieces.push_back(std::move(edge));
  }
  const auto longer = [](const GroundEdge& l, const GroundEdge& r) { return l.extent > r.extent; };
  std::sort(pieces.begin(), pieces.end(), longer);
  std::vector<GroundEdge> edges;
  for (const GroundEdge& piece : pieces) addPiece(axes, edges, piece);
  std::sort(edges.begin(), edges.end(), longer);
  return edges;
}

std::vector<GroundEdge> matchEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                   const std::vector<GroundEdge>& right) {
  std::vector<GroundEdge> matched;
  for (const auto& [l, r] : sameEdges(axes, left, right)) matched.push_back(mean(left[l], right[r]));
  return matched;
}

std::vector<GroundEdge> joinEdges(const GroundAxes& axes, const std::vector<GroundEdge>& left,
                                  const std::vector<GroundEdge>& right) {
  std::vector<GroundEdge> joined = left;
  std::vector<char> taken(right.size(), 0);
  for (const auto& [l, r] : sameEdges(axes, left, right)) {
    joined[l] = mean(left[l], right[r]);
    taken[r] = 1;
  }
  for (size_t i = 0; i < right.size(); ++i)
    if (taken[i] == 0) joined.push_back(right[i]);
  std::stable_sort(joined.begin(), joined.end(),
                   [](const GroundEdge& l, const GroundEdge& r) { return l.extent > r.extent; });
  return joined;
}

}  // namespace uav_landing
