#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/interpolation.h"
#include "kernels/window/window_layout.h"

namespace uav_landing {

/// Weights of the four samples around a place for piecewise parabolic interpolation, tabulated by 1/256 of a
/// pixel. The rounding, 0.002 px, is far below the noise of any match.
class ParabolicTable {
 public:
  static constexpr int kBits = 8;
  static const ParabolicTable& get() {
    static const ParabolicTable table;
    return table;
  }
  /// Weights at a fraction in 1/65536 of a pixel.
  const float* at(std::int32_t fraction) const {
    constexpr int kShift = kFixedBits - kBits;
    return weights_[(fraction + (1 << (kShift - 1))) >> kShift].data();
  }

  /// Positions are fixed-point numbers with this many bits behind the point: they add up exactly and split
  /// fast.
  static constexpr int kFixedBits = 16;
  static std::int32_t fixed(double x) { return cvRound(x * (1 << kFixedBits)); }
  static constexpr std::int32_t kFractionMask = (1 << kFixedBits) - 1;

 private:
  ParabolicTable() {
    for (int i = 0; i <= (1 << kBits); ++i)
      parabolicWeights(static_cast<float>(i) / (1 << kBits), weights_[i].data());
  }
  alignas(16) std::array<std::array<float, 4>, (1 << kBits) + 1> weights_;
};

/// Values along one line of a float image, from (x, y) on, with the step (step_x, step_y), in fixed-point
/// pixels. Four at a time; count is rounded up to a multiple of four. Needs one pixel around all places and
/// two behind them.
inline void sampleParabolicLine(const cv::Mat& image, std::int32_t x, std::int32_t y, std::int32_t step_x,
                                std::int32_t step_y, int count, float* out) {
  using cv::v_float32x4;
  const ParabolicTable& table = ParabolicTable::get();
  const std::ptrdiff_t stride = rowStride(image);
  const float* origin = image.ptr<float>() - stride - 1;
  const auto products = [&] {
    const float* p = origin + (y >> ParabolicTable::kFixedBits) * stride + (x >> ParabolicTable::kFixedBits);
    const float* wy = table.at(y & ParabolicTable::kFractionMask);
    const v_float32x4 column = cv::v_load(p) * cv::v_setall_f32(wy[0]) +
                               cv::v_load(p + stride) * cv::v_setall_f32(wy[1]) +
                               cv::v_load(p + 2 * stride) * cv::v_setall_f32(wy[2]) +
                               cv::v_load(p + 3 * stride) * cv::v_setall_f32(wy[3]);
    const v_float32x4 result = column * cv::v_load_aligned(table.at(x & ParabolicTable::kFractionMask));
    x += step_x;
    y += step_y;
    return result;
  };
  for (int i = 0; i < count; i += 4) {
    const v_float32x4 a = products(), b = products(), c = products(), d = products();
    cv::v_store(out + i, cv::v_reduce_sum4(a, b, c, d));
  }
}

/// The same along a row of the image, where only the column has a fraction.
inline void sampleParabolicRow(const float* row, std::int32_t x, std::int32_t step_x, int count, float* out) {
  using cv::v_float32x4;
  const ParabolicTable& table = ParabolicTable::get();
  const auto products = [&] {
    const v_float32x4 result = cv::v_load(row - 1 + (x >> ParabolicTable::kFixedBits)) *
                               cv::v_load_aligned(table.at(x & ParabolicTable::kFractionMask));
    x += step_x;
    return result;
  };
  for (int i = 0; i < count; i += 4) {
    const v_float32x4 a = products(), b = products(), c = products(), d = products();
    cv::v_store(out + i, cv::v_reduce_sum4(a, b, c, d));
  }
}

/// Values of a float image at at + warp (dx, dy). Rows dy go from -radius to radius, each with stride (a
/// multiple of four) values from dx = -radius on. Up to eight meaningless values follow the last. Needs two
/// pixels around all places and three behind them.
void sampleParabolicWindow(const cv::Mat& image, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp,
                           int radius, int stride, float* out);

/// Values along the rows of a float image, from row v on. Row j has stride (a multiple of four) values from
/// start + j by_row on, with this step. Up to eight meaningless values follow the last. Needs one column
/// before all places and two behind.
void sampleParabolicRows(const cv::Mat& image, int v, double start, double by_row, double step, int rows,
                         int stride, float* out);

}  // namespace uav_landing
