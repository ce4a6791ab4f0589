#include "image/input/row_alternation.h"

#include <cmath>

namespace uav_landing {

double rowAlternation(const cv::Mat& grey) {
  constexpr int kRows = 8, kStep = 3;  // rows of a block, columns
  double fastest = 0, below = 0;
  for (int y = 0; y + kRows <= grey.rows; y += kRows) {
    for (int x = 0; x < grey.cols; x += kStep) {
      double mean = 0, parts[3] = {0, 0, 0};
      for (int i = 0; i < kRows; ++i) mean += grey.at<uint8_t>(y + i, x) / double{kRows};
      for (int i = 0; i < kRows; ++i) {
        const double window = 0.5 - 0.5 * std::cos(2 * M_PI * (i + 1) / (kRows + 1));
        const double value = window * (grey.at<uint8_t>(y + i, x) - mean);
        parts[0] += i % 2 == 0 ? value : -value;
        parts[1] += value * std::cos(2 * M_PI * 3 * i / kRows);
        parts[2] += value * std::sin(2 * M_PI * 3 * i / kRows);
      }
      fastest += parts[0] * parts[0];
      below += parts[1] * parts[1] + parts[2] * parts[2];
    }
  }
  return below > 0 ? fastest / below : fastest > 0 ? 10.0 : 0.0;
}

}  // namespace uav_landing
