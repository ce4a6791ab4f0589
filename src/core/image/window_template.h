#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A square window of the reference image, less its mean, as correlation needs it.
struct WindowTemplate {
  std::vector<float> values;  ///< row by row, (2 radius + 1) squared, grey levels less the mean
  double mean = 0;            ///< grey levels
  double energy = 0;          ///< sum of the squared values

  /// image: CV_32F. False when the window leaves the image or has less than one grey level (RMS) of contrast.
  bool load(const cv::Mat& image, int u, int v, int radius);
};

}  // namespace uav_landing
