#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Memory for images of changing sizes. It only grows, while cv::Mat::create() would allocate again for each
/// size.
class ImageMemory {
 public:
  /// A mono8 image with undefined contents, valid until the next call.
  cv::Mat image(const cv::Size& size) {
    bytes_.resize(std::max(bytes_.size(), static_cast<size_t>(size.area())));
    return cv::Mat(size, CV_8UC1, bytes_.data());
  }

 private:
  std::vector<uchar> bytes_;
};

}  // namespace uav_landing
