#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Samples along a line. The number is known to the compiler.
constexpr int kLineSamples = 96;
using LineGreys = std::array<float, kLineSamples>;
using LinePlaces = std::array<double, kLineSamples>;

/// A line in space and a pinhole camera's intrinsics; points are origin + y direction.
struct LineView {
  Eigen::Vector3d origin, direction;
  double fx, fy, cx, cy;
};

/// Grey levels of a line's points y in an image, by bilinear interpolation. NaN for points behind the camera,
/// outside the image, and where the mask is 0. image: mono8, at least 2 x 2. mask: mono8, odd where it is
/// set. Returns the number of known grey levels.
int sampleLine(const LineView& line, const LinePlaces& y, const cv::Mat& image, const cv::Mat& mask,
               LineGreys& greys);

/// The mean of some lines, sample by sample.
void averageLines(const LineGreys* lines, int count, LineGreys& mean);

}  // namespace uav_landing
