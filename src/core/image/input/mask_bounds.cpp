#include "image/input/mask_bounds.h"

#include <cstring>

namespace uav_landing {

namespace {

bool isEmpty(const uchar* row, int columns) {
  return row[0] == 0 && std::memcmp(row, row + 1, static_cast<size_t>(columns) - 1) == 0;
}

}  // namespace

cv::Rect boundsOf(const cv::Mat& mask) {
  if (mask.empty()) return {};
  int top = 0, bottom = mask.rows - 1;
  while (top <= bottom && isEmpty(mask.ptr<uchar>(top), mask.cols)) ++top;
  if (top > bottom) return {};
  while (isEmpty(mask.ptr<uchar>(bottom), mask.cols)) --bottom;
  int left = mask.cols, right = -1;
  for (int v = top; v <= bottom; ++v) {
    const uchar* row = mask.ptr<uchar>(v);
    for (int u = 0; u < left; ++u)
      if (row[u] != 0) left = u;
    for (int u = mask.cols - 1; u > right; --u)
      if (row[u] != 0) right = u;
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace uav_landing
