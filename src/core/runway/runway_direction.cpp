#include "uav_landing/runway/runway_direction.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "base/image_memory.h"
#include "lines/stripe_line.h"
#include "uav_landing/geometry/half_plane.h"
#include "uav_landing/runway/ground_direction.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;
// By which a line's direction on the ground may be off before its stripe is looked at.
constexpr double kDirectionSlack = 5 * kDegree;

Eigen::Matrix3d viewK(const StereoRig& rig, bool is_left) {
  Eigen::Matrix3d K = rig.K();
  if (!is_left) K(0, 2) = rig.cx_right;
  return K;
}

// The mask without what lies above the horizon (K^-T n) or less than a margin below it, where the far end of
// everything on the ground merges with what stands behind it. Good until the next call.
cv::Mat groundPart(const cv::Mat& mask, const Eigen::Matrix3d& K, const Eigen::Vector3d& normal) {
  static thread_local ImageMemory memory;
  const double margin = 0.01 * mask.rows;
  const Eigen::Vector3d line = K.inverse().transpose() * normal;
  const double scale = line.head<2>().norm();
  cv::Mat ground = memory.image(mask.size());
  keepHalfPlane(mask, line.x(), line.y(), line.z() - margin * scale, ground);
  return ground;
}

std::vector<LineSegment> linesOf(const cv::Mat& image, const cv::Mat& mask, const Eigen::Matrix3d& K,
                                 const Eigen::Vector3d* normal, const ApproachAngleParameters& parameters,
                                 Timings& timings) {
  ScopedTimer timer(timings, "hough_transform");
  return findLines(image, normal ? groundPart(mask, K, *normal) : mask, parameters);
}

// Whether a line lies along the runway, if on the ground; without a normal that is not known.
bool mayBeAlong(const LineSegment& segment, const Eigen::Matrix3d& K, const Eigen::Vector3d* normal,
                double max_yaw) {
  if (normal == nullptr) return true;
  const Eigen::Vector3d along = (K.transpose() * segment.line).cross(*normal);
  return std::abs(along.x()) <= std::tan(max_yaw + kDirectionSlack) * std::abs(along.z());
}

// The lines freed of what blur does to stripes, as far as the vanishing point depends on them: most lines of
// texture run across.
std::vector<LineSegment> straight(const cv::Mat& image, const cv::Mat& mask, const Eigen::Matrix3d& K,
                                  const Eigen::Vector3d* normal, const std::vector<LineSegment>& lines,
                                  const ApproachAngleParameters& parameters, Timings& timings) {
  if (!parameters.stripe_centres) return lines;
  ScopedTimer timer(timings, "hough_transform");
  std::vector<size_t> places;
  std::vector<LineSegment> chosen;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (!mayBeAlong(lines[i], K, normal, parameters.max_yaw_deg * kDegree)) continue;
    places.push_back(i);
    chosen.push_back(lines[i]);
  }
  chosen = withoutStripeBias(image, mask, chosen);
  std::vector<LineSegment> result = lines;
  for (size_t k = 0; k < places.size(); ++k) result[places[k]] = chosen[k];
  return result;
}

void report(const Expected<VanishingPoint>& point, const std::vector<LineSegment>& lines,
            ApproachAngleResult::View& view) {
  for (size_t i = 0; i < lines.size(); ++i)
    view.lines.push_back({lines[i].a, lines[i].b, point && point->inliers[i] != 0});
  if (point) {
    view.vanishing_direction = point->direction;
    view.vanishing_covariance = point->covariance;
  } else {
    view.failure = point.error();
  }
}

}  // namespace

RunwayDirection findRunwayDirection(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                                    const cv::Mat& left_mask, const cv::Mat& right_mask,
                                    const GroundPlane* plane, const ApproachAngleParameters& parameters,
                                    Timings& timings) {
  const Eigen::Matrix3d K_left = viewK(rig, true), K_right = viewK(rig, false);
  const Eigen::Vector3d plane_normal = plane ? plane->normal() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d* normal = plane ? &plane_normal : nullptr;
  RunwayDirection result;
  result.left_lines = linesOf(left, left_mask, K_left, normal, parameters, timings);
  result.right_lines = linesOf(right, right_mask, K_right, normal, parameters, timings);

  const std::vector<LineSegment> left_lines =
      straight(left, left_mask, K_left, normal, result.left_lines, parameters, timings);
  const std::vector<LineSegment> right_lines =
      straight(right, right_mask, K_right, normal, result.right_lines, parameters, timings);

  ScopedTimer timer(timings, "ransac");
  Expected<VanishingPoint> in_left = findVanishingPoint(left_lines, K_left, parameters, normal);
  Expected<VanishingPoint> in_right = findVanishingPoint(right_lines, K_right, parameters, normal);
  if (plane && (!in_left || !in_right)) {
    const auto along = findLinesAlong({{left_lines, K_left}, {right_lines, K_right}}, plane_normal,
                                      plane->normalCovariance(), parameters.max_yaw_deg * kDegree);
    const auto retry = [&](Expected<VanishingPoint>& point, const std::vector<LineSegment>& lines,
                           const Eigen::Matrix3d& K, const std::vector<char>& members) {
      if (point) return;
      Expected<VanishingPoint> fitted = fitVanishingPoint(lines, K, parameters, members, normal);
      if (fitted) point = std::move(fitted);
    };
    if (along) {
      retry(in_left, left_lines, K_left, along->front());
      retry(in_right, right_lines, K_right, along->back());
    }
  }
  report(in_left, result.left_lines, result.left);
  report(in_right, result.right_lines, result.right);
  result.combined = combineVanishingPoints(in_left, in_right, parameters.runway_straightness_deg * kDegree);
  return result;
}

}  // namespace uav_landing
