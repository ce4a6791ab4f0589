#include "faults/view_effects.h"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

cv::Mat homography(const Eigen::Matrix3d& H) {
  cv::Mat result;
  cv::eigen2cv(H, result);
  return result;
}

void warp(cv::Mat& image, const Eigen::Matrix3d& H) {
  cv::Mat warped;
  cv::warpPerspective(image, warped, homography(H), image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  image = warped;
}

/// Grey level of the sky in a perfectly flat surface: a pattern of stripes at infinity.
double skyAt(const Eigen::Vector3d& direction) {
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double elevation = std::asin(std::abs(direction.z()) / direction.norm());
  return 150 + 25 * std::sin(40 * azimuth) * std::cos(60 * elevation) + 15 * std::sin(90 * azimuth + 3);
}

/// Calls visit(pixel, direction, ground point) for all pixels; the point is NaN above the horizon.
template <class Visitor>
void visitGround(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose, Visitor&& visit) {
  const Eigen::Matrix3d R = runwayFromOptical(pose.attitude);
  const Eigen::Vector3d centre = pose.position + camera.offset_x * R.col(0);
  for (int v = 0; v < image.rows; ++v) {
    uchar* row = image.ptr<uchar>(v);
    for (int u = 0; u < image.cols; ++u) {
      const PixelRay& ray = camera.rays[static_cast<size_t>(v) * image.cols + u];
      const Eigen::Vector3d direction = R * Eigen::Vector3d(ray.x, ray.y, 1);
      if (direction.z() > -1e-3) continue;
      const Eigen::Vector3d point = centre - centre.z() / direction.z() * direction;
      row[u] = cv::saturate_cast<uchar>(visit(point, direction, static_cast<double>(row[u])));
    }
  }
}

}  // namespace

void turnCamera(cv::Mat& image, const CameraCalibration& camera, const Eigen::Vector3d& w) {
  // A ray r is then seen as R' r.
  const Eigen::Matrix3d R = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix().transpose();
  warp(image, camera.K * R * camera.K.inverse());
}

void zoomCamera(cv::Mat& image, const CameraCalibration& camera, double factor) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  H.topLeftCorner<2, 2>() *= factor;
  H.topRightCorner<2, 1>() = (1 - factor) * camera.K.topRightCorner<2, 1>();
  warp(image, H);
}

void displace(cv::Mat& image, const Eigen::Vector2d& by) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  H.topRightCorner<2, 1>() = by;
  warp(image, H);
}

void paintGround(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
                 const GroundPaint& paint) {
  visitGround(image, camera, pose, [&](const Eigen::Vector3d& point, const Eigen::Vector3d&, double grey) {
    return paint(point.x(), point.y(), grey);
  });
}

void mirrorSky(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
               const MirrorShare& share) {
  visitGround(image, camera, pose,
              [&](const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double grey) {
                const double mirrored = share(point.x(), point.y());
                return mirrored > 0 ? (1 - mirrored) * grey + mirrored * skyAt(direction) : grey;
              });
}

}  // namespace uav_landing
