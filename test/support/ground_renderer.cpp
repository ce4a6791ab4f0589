#include "support/ground_renderer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace uav_landing {
namespace test {
namespace {

constexpr double kGroundGrey = 105, kPaintGrey = 205, kSkyGrey = 165;
// Texture is this much longer along the runway than across, as seen flat it would else be finer than a pixel.
constexpr double kElongation = 4;
constexpr double kCoarsest = 3;  // m

// Share of [centre - width / 2, centre + width / 2] inside [from, to].
double covered(double centre, double width, double from, double to) {
  const double low = std::max(centre - width / 2, from), high = std::min(centre + width / 2, to);
  return std::max(0.0, high - low) / width;
}

// Integral from 0 to y of a wave that is 1 over the first half of each period.
double waveIntegral(double y, double period) {
  const double whole = std::floor(y / period);
  return (whole * 0.5 + std::min(0.5, y / period - whole)) * period;
}

}  // namespace

Eigen::Matrix3d Pose::worldFromOptical() const {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) * body_from_optical;
}

Movement::Movement(const Pose& then, const Pose& now)
    : R(now.worldFromOptical().transpose() * then.worldFromOptical()),
      t(now.seen(now.position - then.position)) {
  const Eigen::Vector3d step = now.position - then.position;
  angle = std::atan2(-step.z(), step.head<2>().norm());
}

double GroundRenderer::textured(double x, double y, double resolution) const {
  double sum = 0;
  int scale = 0;
  for (double spacing = grain; spacing < kCoarsest; spacing *= 2, ++scale) {
    const double seen = std::exp(-std::pow(resolution / spacing, 2));
    if (seen > 0.01) sum += seen * texture_.at(x / spacing + 17.3 * scale, y / spacing + 31.7 * scale);
  }
  return contrast * sum;
}

double GroundRenderer::paint(double x, double y, double across, double along) const {
  double share = 0;
  if (line_offset > 0) {
    for (const double centre : {-line_offset, line_offset})
      share += covered(y, across, centre - line_width / 2, centre + line_width / 2);
  }
  if (bar_period > 0) {
    const double wave =
        (waveIntegral(y + across / 2, bar_period) - waveIntegral(y - across / 2, bar_period)) / across;
    share += wave * covered(x, along, bar_from, bar_to) * covered(y, across, -bar_reach, bar_reach);
  }
  return std::min(1.0, share);
}

double GroundRenderer::groundLight(double x, double y, double depth, double f, double height) const {
  const double across = depth / f, along = std::max(across, depth * depth / (f * height));
  const double resolution = std::max(across, along / kElongation);
  const double bare = kGroundGrey + textured(x / kElongation, y, resolution);
  const double share = paint(x, y, across, along);
  return (1 - share) * bare + share * (kPaintGrey + 0.3 * (bare - kGroundGrey));
}

bool GroundRenderer::boxLight(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, double f,
                              double* depth, double* light) const {
  bool hit = false;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Array3d a = (boxes[i].low - origin).array() / ray.array();
    const Eigen::Array3d b = (boxes[i].high - origin).array() / ray.array();
    int axis = 0;
    const double enter = a.min(b).maxCoeff(&axis), leave = a.max(b).minCoeff();
    if (enter > leave || enter <= 0 || enter >= *depth) continue;
    const Eigen::Vector3d X = origin + enter * ray;
    *depth = enter;
    *light = 90 + 15.0 * axis +
             textured(X[(axis + 1) % 3] + 7.0 * static_cast<double>(i), X[(axis + 2) % 3], 1.5 * enter / f);
    hit = true;
  }
  return hit;
}

cv::Mat GroundRenderer::draw(const StereoRig& rig, double cx, const Pose& pose, double offset,
                             const Eigen::Vector3d& turn, const Exposure& exposure) const {
  const Eigen::Vector3d origin = pose.position + pose.worldFromOptical() * Eigen::Vector3d(offset, 0, 0);
  Eigen::Matrix3d R = pose.worldFromOptical();
  if (!turn.isZero()) R = R * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  // Noise of its own for every picture.
  const size_t which = std::hash<double>()(pose.position.x() * 1.37 + pose.position.z() + pose.yaw * 0.11 +
                                           pose.roll * 0.013 + offset * 977);
  std::mt19937 random(seed_ + static_cast<unsigned>(which));
  std::normal_distribution<float> noise(0.f, static_cast<float>(std::max(1e-9, exposure.noise)));
  cv::Mat image(rig.size, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      // Third component of the optical ray is 1, so that multiples of it are depths.
      const Eigen::Vector3d ray = R * Eigen::Vector3d((u - cx) / rig.fx, (v - rig.cy) / rig.fy, 1);
      double depth = std::numeric_limits<double>::infinity(), light = kSkyGrey;
      if (ray.z() < 0) {
        depth = -origin.z() / ray.z();
        const Eigen::Vector3d X = origin + depth * ray;
        light = groundLight(X.x(), X.y(), depth, rig.fx, pose.height());
      }
      if (!boxes.empty()) boxLight(origin, ray, rig.fx, &depth, &light);
      image.at<uchar>(v, u) =
          cv::saturate_cast<uchar>(exposure.gain * light + exposure.offset + noise(random));
    }
  }
  return image;
}

StereoRig makeRig(int width, int height, double baseline) {
  StereoRig rig;
  rig.size = {width, height};
  rig.fx = rig.fy = width / 2.0 / std::tan(30 * kDegree);
  rig.cx = width / 2.0 + 1.7;
  rig.cy = height / 2.0 - 2.3;
  rig.cx_right = width / 2.0 - 2.6;
  rig.baseline = baseline;
  return rig;
}

RigModel makeModel(const StereoRig& rig) {
  const cv::Mat everywhere(rig.size, CV_8UC1, cv::Scalar(255));
  return {rig, everywhere, everywhere.clone()};
}

GroundPlane exactPlane(const Pose& pose, double height_share, double normal_stddev) {
  GroundPlane plane;
  const Eigen::Vector3d n = pose.down();
  plane.g = n / pose.height();
  plane.covariance = (std::pow(normal_stddev, 2) * (Eigen::Matrix3d::Identity() - n * n.transpose()) +
                      std::pow(height_share, 2) * n * n.transpose()) /
                     std::pow(pose.height(), 2);
  return plane;
}

}  // namespace test
}  // namespace uav_landing
