#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Harris response of an image row by row, in single precision: sums over 3x3 of the products of 3x3 Sobel
/// gradients; and its local maxima. Keeps the last rows only, so that all of it stays in the cache.
class HarrisRows {
 public:
  /// image: mono8 or float, at least 5 columns wide; must outlive this.
  HarrisRows(const cv::Mat& image, double k);

  /// Computes the response of row v (2 <= v < rows - 2), 0 in the two outermost columns; rows must be asked
  /// for in turn, from 2 on.
  void compute(int v);
  /// Good for whole blocks of kBlock.
  const float* response(int v) { return responseRow(v); }
  /// 1 at the local maxima of row v where allowed, a mask of 0 and 255, is not 0; 0 elsewhere, filled up to
  /// whole blocks of kBlock. Row v + 1 must be the one computed last. Of equal neighbours the last one
  /// counts.
  const uchar* maxima(int v, const uchar* allowed);
  static constexpr int kBlock = 8;

 private:
  float* productRow(int v) { return products_.data() + static_cast<size_t>(v % 3) * 3 * columns_; }
  float* responseRow(int v) { return responses_.data() + static_cast<size_t>(v % 3) * columns_; }

  const cv::Mat& image_;
  float k_;
  int columns_, next_ = 1;
  std::vector<float> products_, responses_;  // three rows each
  std::vector<float> sums_;                  // one row
  std::vector<uchar> maxima_;
};

}  // namespace uav_landing
