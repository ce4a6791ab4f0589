#include "image/input/resampler.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace uav_landing {

namespace {

static_assert(kBilinearOne == cv::INTER_TAB_SIZE, "as in cv::convertMaps()");

/// Moves places, with their weights, so that a pixel exists to the right and below even if its weight is
/// zero.
void keepInside(const cv::Mat& mask, cv::Size source, cv::Mat& places, cv::Mat& weights) {
  const auto clamped = [](int place, int fraction, int size) {
    return place + 1 < size ? std::make_pair(place, fraction) : std::make_pair(size - 2, kBilinearOne);
  };
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u) {
      cv::Vec2s& p = places.at<cv::Vec2s>(v, u);
      std::uint16_t& fraction = weights.at<std::uint16_t>(v, u);
      if (mask.at<uchar>(v, u) == 0) {
        p = {0, 0};
        fraction = 0;
        continue;
      }
      const auto [x, right] = clamped(p[0], fraction % kBilinearOne, source.width);
      const auto [y, below] = clamped(p[1], fraction / kBilinearOne, source.height);
      p = {static_cast<short>(x), static_cast<short>(y)};
      fraction = static_cast<std::uint16_t>(right + 256 * below);
    }
}

}  // namespace

Resampler::Resampler(const cv::Mat& map1, const cv::Mat& map2, const cv::Mat& mask, cv::Size source)
    : places_(map1.clone()), weights_(map2.clone()), mask_(mask) {
  keepInside(mask_, source, places_, weights_);
  if (canBlendWindows() && source.width >= SourceWindows::kColumns && source.height >= SourceWindows::kRows &&
      mask_.cols >= SourceWindows::kPixels)
    findWindows(source);
}

void Resampler::findWindows(cv::Size source) {
  for (int v = 0; v < mask_.rows; ++v)
    for (int u = 0; u < mask_.cols; u += SourceWindows::kPixels) {
      const int first = std::min(u, mask_.cols - SourceWindows::kPixels);
      SourceWindows& windows = windows_.emplace_back();
      for (const int half : {0, 1}) {
        const int begin = first + half * SourceWindows::kHalf;
        if (!findWindow(begin, v, source, windows, half)) apart_.emplace_back(begin, v);
      }
    }
  windows_per_row_ = windows_.size() / mask_.rows;
}

bool Resampler::findWindow(int u, int v, cv::Size source, SourceWindows& windows, int half) const {
  const cv::Vec2s* places = places_.ptr<cv::Vec2s>(v) + u;
  const std::uint16_t* weights = weights_.ptr<std::uint16_t>(v) + u;
  const uchar* mask = mask_.ptr<uchar>(v) + u;
  // Pixels outside the mask may come from anywhere.
  int left = source.width - SourceWindows::kColumns, right = 0, top = source.height - SourceWindows::kRows,
      bottom = 0;
  for (int i = 0; i < SourceWindows::kHalf; ++i) {
    if (mask[i] == 0) continue;
    left = std::min<int>(left, places[i][0]);
    right = std::max<int>(right, places[i][0]);
    top = std::min<int>(top, places[i][1]);
    bottom = std::max<int>(bottom, places[i][1]);
  }
  if (right + 1 >= left + SourceWindows::kColumns || bottom + 1 >= top + SourceWindows::kRows) return false;
  windows.x[half] = static_cast<short>(left);
  windows.y[half] = static_cast<short>(top);
  for (int i = 0; i < SourceWindows::kHalf; ++i) {
    if (mask[i] == 0) continue;
    const int k = half * SourceWindows::kHalf + i;
    windows.place[k] =
        static_cast<uchar>(places[i][0] - left + (places[i][1] > top ? SourceWindows::kNextRow : 0));
    windows.right[k] = static_cast<uchar>(weights[i] & 255);
    windows.below[k] = static_cast<uchar>(weights[i] >> 8);
  }
  return true;
}

void Resampler::resampleRun(const cv::Mat& raw, const cv::Point& first, int count, cv::Mat& out) const {
  const auto [u, v] = std::make_pair(first.x, first.y);
  const PlacedRow row{places_.ptr<short>(v) + 2 * static_cast<std::ptrdiff_t>(u),
                      weights_.ptr<std::uint16_t>(v) + u, mask_.ptr<uchar>(v) + u, count};
  blendRow(raw, row, out.ptr<uchar>(v) + u);
}

void Resampler::resample(const cv::Mat& raw, cv::Mat& out) const {
  out.create(mask_.size(), CV_8UC1);
  if (raw.cols < 2 || raw.rows < 2) {
    out.setTo(0);
    return;
  }
  if (windows_.empty()) {
    for (int v = 0; v < mask_.rows; ++v) resampleRun(raw, {0, v}, mask_.cols, out);
    return;
  }
  for (int v = 0; v < mask_.rows; ++v)
    blendWindows(raw, &windows_[windows_per_row_ * v], mask_.cols, mask_.ptr<uchar>(v), out.ptr<uchar>(v));
  for (const cv::Point& first : apart_) resampleRun(raw, first, SourceWindows::kHalf, out);
}

}  // namespace uav_landing
