#include "kernels/image/transpose.h"

#include <algorithm>
#include <cstddef>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/multiversion.h"

namespace uav_landing {

// 16 x 16 pixels at a time. Interleaving the upper half of the rows with the lower half four times turns rows
// into columns.
UAV_LANDING_MULTIVERSION void transpose(const cv::Mat& image, cv::Mat& transposed) {
  constexpr int kBlock = 16;
  const int rows = image.rows, columns = image.cols;
  if (rows < kBlock || columns < kBlock) return cv::transpose(image, transposed);
  const size_t step = image.step, transposed_step = transposed.step;
  // The last blocks overlap with those before.
  for (int row = 0; row < rows; row += kBlock)
    for (int column = 0; column < columns; column += kBlock) {
      const int v = std::min(row, rows - kBlock), u = std::min(column, columns - kBlock);
      cv::v_uint8x16 block[kBlock], mixed[kBlock];
      const uchar* from = image.ptr<uchar>(v) + u;
      for (int i = 0; i < kBlock; ++i, from += step) block[i] = cv::v_load(from);
      for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < kBlock / 2; ++i)
          cv::v_zip(block[i], block[i + kBlock / 2], mixed[2 * i], mixed[2 * i + 1]);
        for (int i = 0; i < kBlock / 2; ++i)
          cv::v_zip(mixed[i], mixed[i + kBlock / 2], block[2 * i], block[2 * i + 1]);
      }
      uchar* to = transposed.ptr<uchar>(u) + v;
      for (int i = 0; i < kBlock; ++i, to += transposed_step) cv::v_store(to, block[i]);
    }
}

}  // namespace uav_landing
