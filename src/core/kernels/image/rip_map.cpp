#include "kernels/image/rip_map.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

/// Four numbers for one instruction.
using Four = float __attribute__((vector_size(16)));
using FourWhole = int __attribute__((vector_size(16)));

constexpr int kTwice = 3;  ///< texels of a column that are there twice, at its beginning and at its end

/// log2, exact at powers of two and linear in between. Here it only needs to be continuous and monotone.
float roughLog2(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  return static_cast<float>(exponent) + static_cast<float>(bits & 0x7FFFFFu) / 8388608.0f;
}

float powerOfHalf(int exponent) { return 1.0f / static_cast<float>(1 << exponent); }

/// The two copies whose texels are nearest to this width.
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

struct RipMap::Copies {
  Level column, row;
};

/// Where splines begin in the copies, and their weights. Lanes 0 and 1 are the finer and the coarser copy
/// along x, lanes 2 and 3 along y.
struct RipMap::Places {
  FourWhole first;
  Four weight[3];

  Places(float x, float y, const Copies& copies) {
    const int i = copies.column.whole, j = copies.row.whole;
    const Four position =
        Four{x, x, y, y} * Four{powerOfHalf(i), powerOfHalf(i + 1), powerOfHalf(j), powerOfHalf(j + 1)};
    const FourWhole truncated = __builtin_convertvector(position, FourWhole);
    const FourWhole nearest = truncated + (position < __builtin_convertvector(truncated, Four));
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
  for (levels_ = 1; (size >> levels_) > 0;) ++levels_;
  std::vector<cv::Mat> means(static_cast<size_t>(levels_) * levels_);
  copies_.resize(means.size());
  for (int i = 0; i < levels_; ++i) {
    for (int j = 0; j < levels_; ++j) {
      cv::Mat& mean = means[i * levels_ + j];
      if (i + j == 0)
        mean = texels;
      else
        cv::resize(j > 0 ? means[i * levels_ + j - 1] : means[(i - 1) * levels_], mean,
                   cv::Size(size >> i, size >> j), 0, 0, cv::INTER_AREA);
      cv::copyMakeBorder(mean.t(), copies_[i * levels_ + j], 0, 0, 0, kTwice, cv::BORDER_WRAP);
    }
  }
}

/// The spline of one copy. column, row: 0 for the finer, 1 for the coarser one. Lanes hold the three rows.
inline float RipMap::interpolate(const Copies& copies, const Places& places, int column, int row) const {
  const int i = copies.column.whole + column, j = copies.row.whole + row;
  const int columns = 1 << (levels_ - 1 - i), rows = 1 << (levels_ - 1 - j);
  const float* const first = copies_[i * levels_ + j].ptr<float>() + (places.first[2 + row] & (rows - 1));
  Four sums = {};
  for (int k = 0; k < 3; ++k) {
    Four texels;
    std::memcpy(&texels, first + ((places.first[column] + k) & (columns - 1)) * (rows + kTwice),
                sizeof texels);
    sums += places.weight[k][column] * texels;
  }
  return places.weight[0][2 + row] * sums[0] + places.weight[1][2 + row] * sums[1] +
         places.weight[2][2 + row] * sums[2];
}

float RipMap::mean(float x, float y, float width, float height) const {
  const Copies copies{Level(width, levels_), Level(height, levels_)};
  const Places places(x, y, copies);
  const auto blendRows = [&](int column) {
    const float fine = interpolate(copies, places, column, 0);
    if (copies.row.fraction == 0.0f) return fine;
    return fine + copies.row.fraction * (interpolate(copies, places, column, 1) - fine);
  };
  const float fine = blendRows(0);
  if (copies.column.fraction == 0.0f) return fine;
  return fine + copies.column.fraction * (blendRows(1) - fine);
}

}  // namespace uav_landing
