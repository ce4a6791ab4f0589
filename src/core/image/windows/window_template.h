#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// A square window of the reference image minus its mean, as correlation needs it.
struct WindowTemplate {
  std::vector<float> values;  ///< row by row, (2 radius + 1) squared, grey levels minus the mean
  double mean = 0;            ///< grey levels
  double energy = 0;          ///< sum of the squared values

  /// image: CV_32F. False when the window leaves the image, or when its contrast is below one grey level
  /// (RMS).
  bool load(const cv::Mat& image, int u, int v, int radius);
};

}  // namespace uav_landing
