#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "far/outline.h"

namespace uav_landing {

/// A runway as a camera sees it: where every piece of a pixel meets the ground, asked of its own rays.
struct RunwayPicture {
  double width = 45, length = 2500;                // m
  double stripe = 0.9, inset = 0.5, bars = 30;     // m; 0: none
  double ground = 105, surface = 70, paint = 205;  // grey levels
  double across_from = 0, across_to = 0;           // m: paint from edge to edge
  double noise = 2, blur = 0.5;                    // grey levels, px
  cv::Size size{640, 480};
  double focal = 554;

  double greyAt(double x, double y) const {
    const double aside = std::abs(y), end = std::min(x, length - x);
    if (aside > width / 2 || end < 0) return ground;
    if (x > across_from && x < across_to) return paint;
    const double inside = width / 2 - aside;
    if (inside > inset && inside < inset + stripe) return paint;
    if (end > 6 && end < 6 + bars && aside < width / 2 - 3 && std::fmod(aside, 3.5) > 1.75) return paint;
    return surface;
  }

  cv::Mat render(const RunwayPose& pose, unsigned seed = 1) const {
    constexpr int kPieces = 6;
    const Eigen::Matrix3d turned = pose.cameraFromRunway().transpose();
    cv::Mat grey(size, CV_32F, cv::Scalar(160));
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        double sum = 0;
        for (int i = 0; i < kPieces * kPieces; ++i) {
          const double pu = u - 0.5 + (i % kPieces + 0.5) / kPieces,
                       pv = v - 0.5 + (i / kPieces + 0.5) / kPieces;
          const Eigen::Vector3d ray =
              turned * Eigen::Vector3d((pu - size.width / 2) / focal, (pv - size.height / 2) / focal, 1);
          const double far = -pose.position.z() / ray.z();
          sum += ray.z() < -1e-4
                     ? greyAt(pose.position.x() + far * ray.x(), pose.position.y() + far * ray.y())
                     : 160;
        }
        grey.at<float>(v, u) = static_cast<float>(sum / (kPieces * kPieces));
      }
    cv::GaussianBlur(grey, grey, cv::Size(7, 7), blur);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0, static_cast<float>(noise));
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) grey.at<float>(v, u) += normal(random);
    cv::Mat image;
    grey.convertTo(image, CV_8U);
    return image;
  }

  StereoRig rig() const {
    StereoRig result;
    result.size = size;
    result.fx = result.fy = focal;
    result.cx = result.cx_right = size.width / 2;
    result.cy = size.height / 2;
    result.baseline = 1;
    return result;
  }
};

/// What a fit is told of it.
inline OutlineLook lookOf(const RunwayPicture& picture) {
  OutlineLook look;
  look.focal_length = picture.focal;
  look.size = {picture.width, picture.length};
  return look;
}

}  // namespace uav_landing
