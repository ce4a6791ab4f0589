#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Harris response of an image row by row, in single precision, and its local maxima. The response is made of
/// sums over 3x3 of products of 3x3 Sobel gradients. Only the last rows are kept, so that all of it stays in
/// the cache.
class HarrisRows {
 public:
  /// image: mono8 or float, at least 5 columns wide; must outlive this object.
  HarrisRows(const cv::Mat& image, double k);

  /// Computes the response of row v (2 <= v < rows - 2); it is 0 in the two outermost columns. Rows must be
  /// computed in order, from 2 on.
  void compute(int v);
  const float* response(int v) { return responseRow(v); }
  /// One bit per pixel of row v, set at local maxima outside the two outermost columns. The lowest bit is the
  /// first pixel of a block. Row v + 1 must be the one computed last. Of equal neighbours the last one
  /// counts.
  const std::uint64_t* maxima(int v);
  static constexpr int kBlock = 64;

 private:
  float* productRow(int v) { return products_.data() + static_cast<size_t>(v % 3) * 3 * columns_; }
  float* responseRow(int v) { return &responses_[kAround + static_cast<size_t>(v % 3) * blocks_ * kBlock]; }

  static constexpr int kAround = 1;  // responses read beside a row

  const cv::Mat& image_;
  float k_;
  int columns_, next_ = 1;
  std::vector<float> products_;   // three rows
  int blocks_;                    // of a row
  std::vector<float> responses_;  // three rows of whole blocks, 0 where there are none
  std::vector<float> sums_;       // one row
  std::vector<std::uint64_t> maxima_;
};

}  // namespace uav_landing
