#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Samples along a line. The compiler knows how many there are.
constexpr int kLineSamples = 96;
using LineGreys = std::array<float, kLineSamples>;
using LinePlaces = std::array<double, kLineSamples>;

/// A line in space as a pinhole camera has it: points are origin + y direction.
struct LineView {
  Eigen::Vector3d origin, direction;
  double fx, fy, cx, cy;
};

/// The grey levels that a picture shows of the points y of a line, by bilinear interpolation; NaN for points
/// behind the camera, outside the picture, and where the mask is 0. image: mono8, at least 2 x 2; mask:
/// mono8, 1 or more and odd where it is set. Returns how many have a grey level.
int sampleLine(const LineView& line, const LinePlaces& y, const cv::Mat& image, const cv::Mat& mask,
               LineGreys& greys);

/// The mean of some lines, sample by sample.
void averageLines(const LineGreys* lines, int count, LineGreys& mean);

}  // namespace uav_landing
