#include "uav_landing/simulator/camera_rig.h"

#include <Eigen/Geometry>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <string>

#include "geometry/lens.h"

namespace uav_landing {
namespace {

constexpr double kRadiansPerDegree = boost::math::constants::degree<double>();

bool hasFisheye(const CameraCalibration& camera) { return isFisheye(camera.distortion_model, camera.D); }

CameraCalibration lensOf(const SimulatedCameraParameters& camera, const SimulatedImageParameters& image) {
  CameraCalibration calibration;
  calibration.width = image.width;
  calibration.height = image.height;
  if (camera.lens == SimulatedLens::kEquidistant) {
    calibration.distortion_model = "equidistant";
    calibration.D = {camera.k1, camera.k2, camera.k3, camera.k4};
  } else {
    calibration.distortion_model = "plumb_bob";
    calibration.D = {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
  }
  calibration.K << camera.fx, 0, camera.cx,  //
      0, camera.fy, camera.cy,               //
      0, 0, 1;
  return calibration;
}

/// Fills R and P of both cameras. Returns the baseline, m.
double rectify(const SimulatedRigParameters& rig, CameraCalibration& left, CameraCalibration& right) {
  cv::Mat left_k, right_k, axes;
  cv::eigen2cv(left.K, left_k);
  cv::eigen2cv(right.K, right_k);
  cv::Rodrigues(cv::Vec3d(rig.rx_deg, rig.ry_deg, rig.rz_deg) * kRadiansPerDegree, axes);
  // stereoRectify wants x_right = R x_left + T.
  const cv::Mat rotation = axes.t();
  const cv::Mat translation = -rotation * cv::Mat(cv::Vec3d(rig.x, rig.y, rig.z));
  cv::Mat left_r, right_r, left_p, right_p, q;
  const cv::Size size(left.width, left.height);
  if (hasFisheye(left) && hasFisheye(right))
    cv::fisheye::stereoRectify(left_k, left.D, right_k, right.D, size, rotation, translation, left_r, right_r,
                               left_p, right_p, q, cv::CALIB_ZERO_DISPARITY);
  else
    cv::stereoRectify(left_k, left.D, right_k, right.D, size, rotation, translation, left_r, right_r, left_p,
                      right_p, q, cv::CALIB_ZERO_DISPARITY, 0.0);
  cv::cv2eigen(left_r, left.R);
  cv::cv2eigen(right_r, right.R);
  cv::cv2eigen(left_p, left.P);
  cv::cv2eigen(right_p, right.P);
  return -right.P(0, 3) / right.P(0, 0);
}

/// Corners of the pixels, row by row. Pixel (0, 0) reaches from -0.5 to 0.5.
std::vector<cv::Point2d> pixelCorners(const CameraCalibration& calibration) {
  std::vector<cv::Point2d> corners;
  corners.reserve((calibration.width + 1) * (calibration.height + 1));
  for (int v = 0; v <= calibration.height; ++v)
    for (int u = 0; u <= calibration.width; ++u) corners.emplace_back(u - 0.5, v - 0.5);
  return corners;
}

/// Directions (x, y, 1) of raw pixels in rectified axes. The lens is inverted by iteration, then R is
/// applied.
std::vector<cv::Point2d> directionsOf(const std::vector<cv::Point2d>& pixels,
                                      const CameraCalibration& calibration) {
  cv::Mat k, r;
  cv::eigen2cv(calibration.K, k);
  cv::eigen2cv(calibration.R, r);
  std::vector<cv::Point2d> directions;
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
  if (hasFisheye(calibration))
    cv::fisheye::undistortPoints(pixels, directions, k, calibration.D, r);
  else
    cv::undistortPoints(pixels, directions, k, calibration.D, r, cv::noArray(), criteria);
  return directions;
}

/// Projects directions through the lens again. Returns their largest distance from the pixels, px.
double worstReprojection(const std::vector<cv::Point2d>& pixels, const std::vector<cv::Point2d>& directions,
                         const CameraCalibration& calibration) {
  cv::Mat k, inverse_r, rotation;
  cv::eigen2cv(calibration.K, k);
  cv::eigen2cv(Eigen::Matrix3d(calibration.R.transpose()), inverse_r);
  cv::Rodrigues(inverse_r, rotation);
  std::vector<cv::Point3d> points;
  points.reserve(directions.size());
  for (const cv::Point2d& direction : directions) points.emplace_back(direction.x, direction.y, 1.0);
  std::vector<cv::Point2d> images;
  if (hasFisheye(calibration))
    cv::fisheye::projectPoints(points, images, rotation, cv::Vec3d(0, 0, 0), k, calibration.D);
  else
    cv::projectPoints(points, rotation, cv::Vec3d(0, 0, 0), k, calibration.D, images);
  double worst = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const double distance = cv::norm(images[i] - pixels[i]);
    if (!(distance <= worst)) worst = distance;  // also takes over NaN
  }
  return worst;
}

std::vector<PixelRay> raysFromCorners(const std::vector<cv::Point2d>& corners, cv::Size size) {
  std::vector<PixelRay> rays;
  rays.reserve(size.area());
  const int stride = size.width + 1;
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const cv::Point2d* c = &corners[v * stride + u];
      const cv::Point2d centre = 0.25 * (c[0] + c[1] + c[stride] + c[stride + 1]);
      const cv::Point2d along_row = 0.5 * (c[1] - c[0] + c[stride + 1] - c[stride]);
      const cv::Point2d along_column = 0.5 * (c[stride] - c[0] + c[stride + 1] - c[1]);
      rays.push_back({static_cast<float>(centre.x), static_cast<float>(centre.y),
                      static_cast<float>(along_row.x), static_cast<float>(along_row.y),
                      static_cast<float>(along_column.x), static_cast<float>(along_column.y)});
    }
  }
  return rays;
}

/// Directions of a camera that has turned by a rotation vector (rectified axes, rad).
void turn(std::vector<cv::Point2d>& directions, const Eigen::Vector3d& rotation) {
  if (rotation.isZero()) return;
  const Eigen::Matrix3d R(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
  for (cv::Point2d& direction : directions) {
    const Eigen::Vector3d turned = R * Eigen::Vector3d(direction.x, direction.y, 1);
    direction = {turned.x() / turned.z(), turned.y() / turned.z()};
  }
}

/// Errors of the lens that the calibration leaves: rows lie lower (focal lengths) and are inclined (rad).
void shearRows(std::vector<cv::Point2d>& directions, double lower, double inclined) {
  for (cv::Point2d& direction : directions) direction.y -= lower + inclined * direction.x;
}

/// Errors of a camera that the calibration does not know.
struct Uncalibrated {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rotation vector, rad
  double lower = 0, inclined = 0;                  // see shearRows()
};

Failure traceRays(const char* section, const Uncalibrated& error, SimulatedCamera& camera) {
  const std::vector<cv::Point2d> pixels = pixelCorners(camera.calibration);
  std::vector<cv::Point2d> directions = directionsOf(pixels, camera.calibration);
  if (!(worstReprojection(pixels, directions, camera.calibration) < 0.01))
    return {Reason::kInputInvalid,
            std::string(section) + "/k1: the lens's distortion folds back within the image"};
  turn(directions, error.turn);
  shearRows(directions, error.lower, error.inclined);
  camera.rays = raysFromCorners(directions, {camera.calibration.width, camera.calibration.height});
  return {};
}

}  // namespace

Expected<CameraRig> makeCameraRig(const SimulatorParameters& parameters) {
  CameraRig rig;
  rig.left.calibration = lensOf(parameters.left_camera, parameters.image);
  rig.right.calibration = lensOf(parameters.right_camera, parameters.image);
  if (hasFisheye(rig.left.calibration) != hasFisheye(rig.right.calibration))
    return tl::make_unexpected(
        Failure{Reason::kInputInvalid,
                "right_camera/lens: expected the lens of left_camera, as both are rectified together"});
  rig.right.offset_x = rectify(parameters.rig, rig.left.calibration, rig.right.calibration);
  constexpr double kLeastForward = 0.7;  // cosine of 45 degrees, for the optical axis after rectification
  const bool usable = rig.right.offset_x > 0 && rig.left.calibration.P.allFinite() &&
                      rig.right.calibration.P.allFinite() && rig.left.calibration.R(2, 2) > kLeastForward;
  if (!usable)
    return tl::make_unexpected(Failure{
        Reason::kInputInvalid, "rig: the cameras stand too far out of line to be rectified as a pair"});
  if (Failure failure = traceRays("left_camera", {}, rig.left)) return tl::make_unexpected(failure);
  const SimulatedRigParameters& bent = parameters.rig;
  const Uncalibrated error{
      Eigen::Vector3d(bent.bend_rx_deg, bent.bend_ry_deg, bent.bend_rz_deg) * kRadiansPerDegree,
      bent.lens_rows / parameters.right_camera.fy, bent.lens_tilt_deg * kRadiansPerDegree};
  if (Failure failure = traceRays("right_camera", error, rig.right)) return tl::make_unexpected(failure);
  rig.right.offset_x *= 1 + bent.stretch;
  return rig;
}

}  // namespace uav_landing
