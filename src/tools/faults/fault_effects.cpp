#include "faults/fault_effects.h"

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

void changeExposure(cv::Mat& image, double gain, double offset) {
  image.convertTo(image, CV_8U, gain, offset);
}

void blur(cv::Mat& image, double sigma) { cv::GaussianBlur(image, image, cv::Size(), sigma); }

void fogLens(cv::Mat& image, cv::RNG& random) {
  blur(image, 8);
  changeExposure(image, 0.3, 120);
  addNoise(image, 2, random);
}

void smear(cv::Mat& image, int pixels) {
  cv::Mat smeared;
  cv::blur(image, smeared, cv::Size(pixels, 1));
  image = smeared;
}

void addNoise(cv::Mat& image, double sigma, cv::RNG& random) {
  cv::Mat noise(image.size(), CV_16S), sum;
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  image = sum;
}

void soil(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat cover(image.size(), CV_32F, cv::Scalar(1));
  for (int i = 0; i < 25; ++i) {
    const cv::Point at(random.uniform(0, image.cols), random.uniform(image.rows / 3, image.rows));
    cv::circle(cover, at, random.uniform(image.cols / 60, image.cols / 20), cv::Scalar(0.25), cv::FILLED);
  }
  cv::GaussianBlur(cover, cover, cv::Size(), image.cols / 160.0);
  cv::Mat grey;
  image.convertTo(grey, CV_32F);
  cv::Mat(grey.mul(cover)).convertTo(image, CV_8U);
}

void wet(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, cv::Size(), image.cols / 100.0);
  for (int i = 0; i < 20; ++i) {
    const int radius = random.uniform(image.cols / 50, image.cols / 16);
    const cv::Point at(random.uniform(radius, image.cols - radius),
                       random.uniform(image.rows / 3, image.rows - radius));
    // A drop is a lens, so it shows its surroundings upside down.
    const cv::Rect box(at.x - radius, at.y - radius, 2 * radius, 2 * radius);
    if ((box & cv::Rect(cv::Point(), image.size())) != box) continue;
    cv::Mat flipped, mask(box.size(), CV_8U, cv::Scalar(0));
    cv::flip(blurred(box), flipped, 0);
    cv::circle(mask, cv::Point(radius, radius), radius - 1, cv::Scalar(255), cv::FILLED);
    flipped.copyTo(image(box), mask);
  }
}

void glare(cv::Mat& image) {
  const cv::Point2d sun(0.6 * image.cols, 0.3 * image.rows);
  for (int v = 0; v < image.rows; ++v) {
    uchar* row = image.ptr<uchar>(v);
    for (int u = 0; u < image.cols; ++u) {
      const double r = std::hypot(u - sun.x, v - sun.y) / image.cols;
      row[u] = cv::saturate_cast<uchar>(0.7 * row[u] + 60 + 300 * std::exp(-r / 0.12));
    }
  }
}

void band(cv::Mat& image, double phase) {
  for (int v = 0; v < image.rows; ++v) {
    const double gain = 1 + 0.35 * std::sin(2 * M_PI * (6.0 * v / image.rows) + phase);
    cv::Mat row = image.row(v);
    row.convertTo(row, CV_8U, gain);
  }
}

void night(cv::Mat& image, uint64_t seed) {
  cv::RNG random(seed);
  image.convertTo(image, CV_8U, 0.04, 2);
  addNoise(image, 2, random);
}

void paintGround(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
                 const GroundPaint& paint) {
  visitGround(image, camera, pose, [&](const Eigen::Vector3d& point, const Eigen::Vector3d&, double grey) {
    return paint(point.x(), point.y(), grey);
  });
}

void mirrorSky(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose, double near_x,
               double far_x) {
  visitGround(image, camera, pose,
              [&](const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double grey) {
                return point.x() > near_x && point.x() < far_x ? skyAt(direction) : grey;
              });
}

}  // namespace uav_landing
