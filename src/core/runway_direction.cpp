#include "uav_landing/runway_direction.h"

#include <Eigen/LU>
#include <cmath>

#include "uav_landing/half_plane.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Matrix3d viewK(const StereoRig& rig, bool is_left) {
  Eigen::Matrix3d K = rig.K();
  if (!is_left) K(0, 2) = rig.cx_right;
  return K;
}

// The mask without what lies above the horizon (K^-T n) or less than a margin below it, where the far end of
// everything on the ground merges with what stands behind it.
cv::Mat groundPart(const cv::Mat& mask, const Eigen::Matrix3d& K, const Eigen::Vector3d& normal) {
  const double margin = 0.01 * mask.rows;
  const Eigen::Vector3d line = K.inverse().transpose() * normal;
  const double scale = line.head<2>().norm();
  cv::Mat ground = mask.clone();
  keepHalfPlane(ground, line.x(), line.y(), line.z() - margin * scale);
  return ground;
}

Expected<VanishingPoint> analyse(const cv::Mat& image, const cv::Mat& mask, const Eigen::Matrix3d& K,
                                 const Eigen::Vector3d* normal, const ApproachAngleParameters& parameters,
                                 Timings& timings, ApproachAngleResult::View& view,
                                 std::vector<LineSegment>& lines) {
  {
    ScopedTimer timer(timings, "hough_transform");
    lines = findLines(image, normal ? groundPart(mask, K, *normal) : mask, parameters);
  }
  ScopedTimer timer(timings, "ransac");
  const Expected<VanishingPoint> point = findVanishingPoint(lines, K, parameters, normal);
  for (size_t i = 0; i < lines.size(); ++i) {
    view.lines.push_back({lines[i].a, lines[i].b, point && point->inliers[i] != 0});
  }
  if (point) {
    view.vanishing_direction = point->direction;
    view.vanishing_covariance = point->covariance;
  } else {
    view.failure = point.error();
  }
  return point;
}

}  // namespace

RunwayDirection findRunwayDirection(const StereoRig& rig, const cv::Mat& left, const cv::Mat& right,
                                    const cv::Mat& left_mask, const cv::Mat& right_mask,
                                    const Eigen::Vector3d* normal, const ApproachAngleParameters& parameters,
                                    Timings& timings) {
  RunwayDirection result;
  const Expected<VanishingPoint> in_left =
      analyse(left, left_mask, viewK(rig, true), normal, parameters, timings, result.left, result.left_lines);
  const Expected<VanishingPoint> in_right = analyse(right, right_mask, viewK(rig, false), normal, parameters,
                                                    timings, result.right, result.right_lines);
  result.combined = combineVanishingPoints(in_left, in_right, parameters.runway_straightness_deg * kDegree);
  return result;
}

}  // namespace uav_landing
