#include "kernels/image/rip_map.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

/// Four numbers for one instruction.
using Four = float __attribute__((vector_size(16)));
using IntFour = int __attribute__((vector_size(16)));

/// Texels of a column that are there twice, at its beginning and at its end: two for a spline that begins
/// with the last one, and one that is loaded and has no weight.
constexpr int kTwice = 3;

/// log2, exact at powers of two and linear in between. Here it only needs to be continuous and monotone.
float roughLog2(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  return static_cast<float>(exponent) + static_cast<float>(bits & 0x7FFFFFu) / 8388608.0f;
}

float powerOfHalf(int exponent) { return 1.0f / static_cast<float>(1 << exponent); }

/// The two levels whose texels are nearest to this width.
struct Level {
  int whole;
  float fraction;  ///< of the coarser one
  Level(float width, int levels) {
    const float exact = std::clamp(roughLog2(width), 0.0f, static_cast<float>(levels - 1));
    whole = std::min(static_cast<int>(exact), levels - 2);
    fraction = exact - static_cast<float>(whole);
  }
};

}  // namespace

struct RipMap::Levels {
  Level column, row;
};

/// Where splines begin in the levels, and their weights. Lanes 0 and 1 are the finer and the coarser level
/// along x, lanes 2 and 3 along y.
struct RipMap::Taps {
  IntFour first;
  Four weight[3];

  Taps(float x, float y, const Levels& levels) {
    const int i = levels.column.whole, j = levels.row.whole;
    const Four position =
        Four{x, x, y, y} * Four{powerOfHalf(i), powerOfHalf(i + 1), powerOfHalf(j), powerOfHalf(j + 1)};
    // Rounded down. std::floor is a function call on processors without SSE 4.1.
    const IntFour truncated = __builtin_convertvector(position, IntFour);
    const IntFour nearest = truncated + (position < __builtin_convertvector(truncated, Four));
    const Four t = position - __builtin_convertvector(nearest, Four) - 0.5f;
    first = nearest - 1;
    weight[0] = 0.5f * (0.5f - t) * (0.5f - t);
    weight[1] = 0.75f - t * t;
    weight[2] = 0.5f * (0.5f + t) * (0.5f + t);
  }
};

RipMap::RipMap(const cv::Mat& texels) {
  const int size = texels.cols;
  CV_Assert(texels.type() == CV_32FC1 && texels.rows == size && size >= 2 && (size & (size - 1)) == 0);
  for (count_ = 1; (size >> count_) > 0;) ++count_;
  std::vector<cv::Mat> means(static_cast<size_t>(count_) * count_);
  levels_.resize(means.size());
  for (int i = 0; i < count_; ++i) {
    for (int j = 0; j < count_; ++j) {
      cv::Mat& mean = means[i * count_ + j];
      if (i + j == 0)
        mean = texels;
      else
        cv::resize(j > 0 ? means[i * count_ + j - 1] : means[(i - 1) * count_], mean,
                   cv::Size(size >> i, size >> j), 0, 0, cv::INTER_AREA);
      cv::copyMakeBorder(mean.t(), levels_[i * count_ + j], 0, 0, 0, kTwice, cv::BORDER_WRAP);
    }
  }
}

/// The spline of one level. column, row: 0 for the finer, 1 for the coarser one. Lanes hold the three rows.
inline float RipMap::interpolate(const Levels& levels, const Taps& taps, int column, int row) const {
  const int i = levels.column.whole + column, j = levels.row.whole + row;
  const int columns = 1 << (count_ - 1 - i), rows = 1 << (count_ - 1 - j);
  const float* const first = levels_[i * count_ + j].ptr<float>() + (taps.first[2 + row] & (rows - 1));
  Four sums = {};
  for (int k = 0; k < 3; ++k) {
    Four texels;
    std::memcpy(&texels, first + ((taps.first[column] + k) & (columns - 1)) * (rows + kTwice), sizeof texels);
    sums += taps.weight[k][column] * texels;
  }
  return taps.weight[0][2 + row] * sums[0] + taps.weight[1][2 + row] * sums[1] +
         taps.weight[2][2 + row] * sums[2];
}

float RipMap::mean(float x, float y, float width, float height) const {
  const Levels levels{Level(width, count_), Level(height, count_)};
  const Taps taps(x, y, levels);
  const auto blendRows = [&](int column) {
    const float fine = interpolate(levels, taps, column, 0);
    if (levels.row.fraction == 0.0f) return fine;
    return fine + levels.row.fraction * (interpolate(levels, taps, column, 1) - fine);
  };
  const float fine = blendRows(0);
  if (levels.column.fraction == 0.0f) return fine;
  return fine + levels.column.fraction * (blendRows(1) - fine);
}

}  // namespace uav_landing
