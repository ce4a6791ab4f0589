#include "uav_landing/image/rectification.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "geometry/lens.h"
#include "geometry/raw_places.h"
#include "image/input/resampler.h"

namespace uav_landing {

namespace {

constexpr float kOutside = -2;  // a source coordinate whose neighbouring pixels are all outside the image
constexpr double kMaxRadius =
    20.0;  // on the plane z = 1: 87 degrees off the axis, which no lens of these models sees

/// Distance from the axis at which the lens shows a point that is r off the axis, both on the plane z = 1.
/// Negative when it shows it nowhere. OpenCV's radial model of plumb_bob and rational_polynomial.
double radialDistance(const std::vector<double>& D, double r) {
  const auto k = [&D](size_t i) { return i < D.size() ? D[i] : 0.0; };
  const double r2 = r * r, denominator = 1 + r2 * (k(5) + r2 * (k(6) + r2 * k(7)));
  return denominator > 0 ? r * (1 + r2 * (k(0) + r2 * (k(1) + r2 * k(4)))) / denominator : -1;
}

/// The same for a fisheye lens: an odd polynomial of the angle off the axis.
double fisheyeDistance(const std::vector<double>& D, double r) {
  const double angle = std::atan(r), a2 = angle * angle;
  return angle * (1 + a2 * (D[0] + a2 * (D[1] + a2 * (D[2] + a2 * D[3]))));
}

/// Radius, on the plane z = 1, at which the distance in the image stops growing. Beyond it the polynomial
/// folds back into the image and means nothing. Searched up to max_radius; infinity when it never stops
/// growing.
double foldRadius(const CameraCalibration& c, double max_radius) {
  constexpr int kSteps = 10000;
  if (!isDistorted(c.D)) return std::numeric_limits<double>::infinity();
  double previous = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = max_radius * i / kSteps;
    const double distorted =
        isFisheye(c.distortion_model, c.D) ? fisheyeDistance(c.D, r) : radialDistance(c.D, r);
    if (distorted <= previous) return r;
    previous = distorted;
  }
  return std::numeric_limits<double>::infinity();
}

/// Distance from the axis, on the plane z = 1 of the raw camera, of the point that a rectified pixel looks
/// at. False when this point is behind the camera or nearly so.
bool seenRadius(const Eigen::Matrix3d& from_pixel, int u, int v, double& radius) {
  const Eigen::Vector3d ray = from_pixel * Eigen::Vector3d(u, v, 1);
  radius = std::hypot(ray.x(), ray.y()) / ray.z();
  return ray.z() > 0 && radius < kMaxRadius;
}

/// Moves pixels out of the image that only seem to be in it: folded distortion, rays from behind, overflows.
void excludeUnreal(const CameraCalibration& c, cv::Mat& x, cv::Mat& y) {
  const Eigen::Matrix3d from_pixel = (c.P.leftCols<3>() * c.R).inverse();
  double max_radius = 0, radius = 0;
  for (const int u : {0, c.width - 1})
    for (const int v : {0, c.height - 1})
      max_radius = std::max(max_radius, seenRadius(from_pixel, u, v, radius) ? radius : kMaxRadius);
  const double fold = foldRadius(c, max_radius);
  for (int v = 0; v < y.rows; ++v)
    for (int u = 0; u < y.cols; ++u) {
      float &xs = x.at<float>(v, u), &ys = y.at<float>(v, u);
      const bool near = xs > kOutside && xs <= c.width && ys > kOutside && ys <= c.height;
      if (near && seenRadius(from_pixel, u, v, radius) && radius < fold) continue;
      xs = ys = kOutside;
    }
}

/// Source of each rectified pixel, in 1/32 px, as cv::convertMaps makes it.
struct SourceMaps {
  cv::Mat places, fractions;
};

/// c: of the delivered image, already checked.
SourceMaps sourceMaps(const CameraCalibration& c) {
  RawPlaces raw = rawPlaces(c, c.P.leftCols<3>(), c.imageSize());
  excludeUnreal(c, raw.x, raw.y);
  SourceMaps maps;
  cv::convertMaps(raw.x, raw.y, maps.places, maps.fractions, CV_16SC2);
  return maps;
}

/// 255 where interpolation uses only these pixels of the raw image (mono8, not 0).
cv::Mat sourceMask(const SourceMaps& maps, const cv::Mat& usable) {
  cv::Mat mask(maps.places.size(), CV_8UC1);
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u) {
      const cv::Vec2s p = maps.places.at<cv::Vec2s>(v, u);
      const int fraction = maps.fractions.at<ushort>(v, u);
      const int right = p[0] + (fraction % cv::INTER_TAB_SIZE > 0),
                below = p[1] + (fraction / cv::INTER_TAB_SIZE > 0);
      const bool inside = p[0] >= 0 && p[1] >= 0 && right < usable.cols && below < usable.rows;
      mask.at<uchar>(v, u) = inside && usable.at<uchar>(p[1], p[0]) != 0 &&
                                     usable.at<uchar>(p[1], right) != 0 &&
                                     usable.at<uchar>(below, p[0]) != 0 && usable.at<uchar>(below, right) != 0
                                 ? 255
                                 : 0;
    }
  return mask;
}

/// Whether the maps lead every pixel to itself, because the image is already rectified.
bool isIdentity(const SourceMaps& maps) {
  for (int v = 0; v < maps.places.rows; ++v)
    for (int u = 0; u < maps.places.cols; ++u)
      if (maps.places.at<cv::Vec2s>(v, u) != cv::Vec2s(static_cast<short>(u), static_cast<short>(v)) ||
          maps.fractions.at<ushort>(v, u) != 0)
        return false;
  return true;
}

/// usable: pixels of the raw image that may be used (mono8, not 0); empty: all.
cv::Mat validityMask(const SourceMaps& maps, const cv::Mat& usable) {
  const cv::Size size = maps.places.size();
  const cv::Mat mask = sourceMask(maps, usable.empty() ? cv::Mat(size, CV_8UC1, cv::Scalar(255)) : usable);
  const bool interpolates = size.width >= 2 && size.height >= 2;
  return interpolates || isIdentity(maps) ? mask : cv::Mat(size, CV_8UC1, cv::Scalar(0));
}

}  // namespace

Expected<Rectifier> Rectifier::create(const CameraCalibration& calibration) {
  if (Failure failure = checkCalibration(calibration)) return tl::unexpected(failure);
  const CameraCalibration delivered = calibration.ofDeliveredImage();
  const SourceMaps maps = sourceMaps(delivered);
  Rectifier rectifier;
  rectifier.calibration_ = calibration;
  rectifier.mask_ = validityMask(maps, {});
  if (isIdentity(maps)) return rectifier;
  rectifier.resampler_ =
      std::make_shared<Resampler>(maps.places, maps.fractions, rectifier.mask_, delivered.imageSize());
  return rectifier;
}

Failure Rectifier::rectify(const cv::Mat& raw, cv::Mat& out) const {
  if (raw.type() != CV_8UC1) return {Reason::kInputInvalid, "image is not 8 bit grey"};
  const auto text = [](cv::Size s) { return std::to_string(s.width) + "x" + std::to_string(s.height); };
  if (raw.size() != mask_.size())
    return {Reason::kInputInvalid,
            "image is " + text(raw.size()) + ", its camera_info says " + text(mask_.size())};
  if (resampler_)
    resampler_->resample(raw, out);
  else
    raw.copyTo(out);
  return {};
}

Expected<RigModel> makeRigModel(const CameraCalibration& left, const CameraCalibration& right,
                                const RigMasks& masks, const RigParameters& parameters) {
  const Expected<StereoRig> rig = makeStereoRig(left, right);
  if (!rig) return tl::unexpected(rig.error());
  if (Failure failure = checkMaskSize(masks.left, left)) return tl::unexpected(failure);
  if (Failure failure = checkMaskSize(masks.right, right)) return tl::unexpected(failure);
  const Readout unknown = unknownReadout(parameters);
  return RigModel{*rig,
                  validityMask(sourceMaps(left.ofDeliveredImage()), masks.left.usable),
                  validityMask(sourceMaps(right.ofDeliveredImage()), masks.right.usable),
                  RowTimes(left, leftReadout(parameters)),
                  RowTimes(right, rightReadout(parameters)),
                  RowTimes(left, unknown),
                  parameters.estimate_readout_time && unknown.time != 0};
}

}  // namespace uav_landing
