#include "runway/direction/ground_direction.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "estimation/limits.h"
#include "runway/direction/ground_edges.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kLeastExtent = 0.25;  // least log(far / near) of a line that counts
constexpr double kLeastSum = 1.5;      // least sum of log(far / near) over both views
constexpr double kLeastMargin = 1.4;   // ratio to any other direction
constexpr Sigmas kGate(3);
constexpr double kStraight = 0.03 * kDegree;    // 1 sigma by which the edges of one runway are not parallel
constexpr double kLargestStddev = 1 * kDegree;  // of a line's direction, for lines that count
constexpr double kLeastSpread = 0.3;            // heights between the outermost lines of one view

/// A line on the ground with its direction.
struct Direction {
  size_t view, index;
  double azimuth, variance;   // left of the axis, rad; variance from the image alone
  Eigen::Vector2d by_normal;  // derivatives by rotations of the normal about forward and about left
  double extent;
  double lateral;  // left of the camera where the line passes it, in heights
};

class Finder {
 public:
  Finder(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance, double max_yaw)
      : normal_(normal), max_yaw_(max_yaw) {
    forward_ = (Eigen::Vector3d::UnitZ() - normal.z() * normal).normalized();
    left_ = forward_.cross(normal);
    Eigen::Matrix<double, 2, 3> tips;
    tips << left_.transpose(), -forward_.transpose();
    covariance_ = tips * covariance * tips.transpose();
  }

  void add(size_t view, const ViewLines& lines) {
    const Eigen::Matrix3d Kinv = lines.K.inverse();
    for (size_t i = 0; i < lines.lines.size(); ++i) {
      const LineSegment& line = lines.lines[i];
      const Eigen::Vector3d a = Kinv * line.a.homogeneous(), b = Kinv * line.b.homogeneous();
      if (std::min(normal_.dot(a), normal_.dot(b)) < GroundAxes::kLeastSlope) continue;
      const double xa = forward_.dot(a) / normal_.dot(a), xb = forward_.dot(b) / normal_.dot(b);
      if (std::min(xa, xb) <= 0) continue;
      Direction d;
      d.view = view;
      d.index = i;
      d.extent = std::abs(std::log(xa / xb));
      const Eigen::Vector3d plane = lines.K.transpose() * line.line;
      d.azimuth = azimuth(plane, normal_);
      if (d.extent < kLeastExtent || std::abs(d.azimuth) > max_yaw_) continue;
      d.variance = varianceOf(line, lines.K);
      if (d.variance > kLargestStddev * kLargestStddev) continue;
      constexpr double kStep = 1e-4;
      for (int k = 0; k < 2; ++k) {
        const Eigen::Vector3d axis = k == 0 ? forward_ : left_;
        const Eigen::Vector3d turned = (normal_ + kStep * axis.cross(normal_)).normalized();
        d.by_normal[k] = (azimuth(plane, turned) - d.azimuth) / kStep;
      }
      d.lateral = left_.dot(a) / normal_.dot(a) - std::tan(d.azimuth) * xa;
      directions_.push_back(d);
    }
  }

  std::optional<std::vector<Direction>> best() const {
    std::vector<double> scores;
    for (const Direction& d : directions_) scores.push_back(score(d));
    if (scores.empty()) return std::nullopt;
    const size_t top = std::max_element(scores.begin(), scores.end()) - scores.begin();
    if (scores[top] < kLeastSum) return std::nullopt;
    for (size_t i = 0; i < scores.size(); ++i)
      if (!agree(directions_[i], directions_[top], 2) && scores[i] * kLeastMargin > scores[top])
        return std::nullopt;
    std::vector<Direction> members;
    double spread = 0;
    for (const Direction& d : directions_) {
      if (!agree(d, directions_[top], 1)) continue;
      for (const Direction& other : members)
        if (other.view == d.view) spread = std::max(spread, std::abs(other.lateral - d.lateral));
      members.push_back(d);
    }
    if (spread < kLeastSpread) return std::nullopt;
    return members;
  }

 private:
  /// Azimuth of a line on the ground. plane: normal of the plane through the line and the camera.
  double azimuth(const Eigen::Vector3d& plane, const Eigen::Vector3d& normal) const {
    Eigen::Vector3d along = plane.cross(normal);
    if (along.dot(forward_) < 0) along = -along;
    return std::atan2(along.dot(left_), along.dot(forward_));
  }

  double varianceOf(const LineSegment& segment, const Eigen::Matrix3d& K) const {
    const Eigen::Vector2d across = segment.line.head<2>(), along(-across.y(), across.x());
    const auto moved = [&](double offset, double angle) {
      const Eigen::Vector2d turned = (across + angle * along).normalized();
      const Eigen::Vector3d line(turned.x(), turned.y(), -turned.dot(segment.middle() + offset * across));
      return azimuth(K.transpose() * line, normal_);
    };
    const double here = moved(0, 0);
    return std::pow(moved(segment.offset_stddev, 0) - here, 2) +
           std::pow(moved(0, segment.angle_stddev) - here, 2);
  }

  double ratio2(const Direction& a, const Direction& b) const {
    const Eigen::Vector2d differ = a.by_normal - b.by_normal;
    return std::pow(a.azimuth - b.azimuth, 2) /
           (a.variance + b.variance + differ.dot(covariance_ * differ) + kStraight * kStraight);
  }
  bool agree(const Direction& a, const Direction& b, double gates) const {
    return ratio2(a, b) <= std::pow(gates * kGate.count(), 2);
  }
  double score(const Direction& centre) const {
    double sum = 0;
    for (const Direction& d : directions_)
      sum += d.extent * std::max(0.0, 1 - ratio2(d, centre) / kGate.squared());
    return sum;
  }

  Eigen::Vector3d normal_, forward_, left_;
  Eigen::Matrix2d covariance_;  // of the rotations of the normal about forward and about left, rad^2
  double max_yaw_;
  std::vector<Direction> directions_;
};

}  // namespace

std::optional<LinesAlong> findLinesAlong(const std::vector<ViewLines>& views, const Eigen::Vector3d& normal,
                                         const Eigen::Matrix3d& normal_covariance, double max_yaw) {
  Finder finder(normal, normal_covariance, max_yaw);
  LinesAlong along;
  for (size_t view = 0; view < views.size(); ++view) {
    finder.add(view, views[view]);
    along.emplace_back(views[view].lines.size(), 0);
  }
  const auto members = finder.best();
  if (!members) return std::nullopt;
  for (const Direction& member : *members) along[member.view][member.index] = 1;
  return along;
}

}  // namespace uav_landing
