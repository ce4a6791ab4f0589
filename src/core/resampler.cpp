#include "resampler.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "multiversion.h"
#if defined(__x86_64__) && defined(__GNUC__)
#define UAV_LANDING_HAS_SHUFFLE
#include <immintrin.h>
#endif

namespace uav_landing {

namespace {

constexpr int kOne = cv::INTER_TAB_SIZE;  // weights are in 1 / this

/// Moves places, with their weights, so that there is a pixel to the right and below even where it has no
/// weight.
void keepInside(const cv::Mat& mask, cv::Size source, cv::Mat& places, cv::Mat& weights) {
  const auto clamped = [](int place, int fraction, int size) {
    return place + 1 < size ? std::make_pair(place, fraction) : std::make_pair(size - 2, kOne);
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
      const auto [x, right] = clamped(p[0], fraction % kOne, source.width);
      const auto [y, below] = clamped(p[1], fraction / kOne, source.height);
      p = {static_cast<short>(x), static_cast<short>(y)};
      fraction = static_cast<std::uint16_t>(right + 256 * below);
    }
}

/// Where in the source's memory a row of places, (x, y) each, is.
UAV_LANDING_MULTIVERSION void findOffsets(const short* __restrict places, int count, int step,
                                          int* __restrict offsets) {
  for (int u = 0; u < count; ++u) offsets[u] = places[2 * u + 1] * step + places[2 * u];
}

/// The two pixels from each offset on, the first in the lower byte.
void gather(const uchar* source, const int* offsets, int count, std::uint16_t* pairs) {
  for (int u = 0; u < count; ++u) std::memcpy(pairs + u, source + offsets[u], sizeof(*pairs));
}

/// Bilinear interpolation in fixed point, rounded, between pairs of pixels of an upper and a lower row.
UAV_LANDING_MULTIVERSION void blend(const std::uint16_t* __restrict upper,
                                    const std::uint16_t* __restrict lower,
                                    const std::uint16_t* __restrict weights, const uchar* __restrict mask,
                                    int count, uchar* __restrict out) {
  for (int u = 0; u < count; ++u) {
    const short right = static_cast<short>(weights[u] & 255), below = static_cast<short>(weights[u] >> 8);
    const short left = static_cast<short>(kOne - right), above = static_cast<short>(kOne - below);
    const short a = static_cast<short>((upper[u] & 255) * left + (upper[u] >> 8) * right);
    const short b = static_cast<short>((lower[u] & 255) * left + (lower[u] >> 8) * right);
    const unsigned grey = static_cast<unsigned>(a * above + b * below + kOne * kOne / 2) / (kOne * kOne);
    out[u] = static_cast<uchar>(grey & mask[u]);
  }
}

#ifdef UAV_LANDING_HAS_SHUFFLE
bool hasShuffle() { return __builtin_cpu_supports("avx2") != 0; }

inline __m128i eightBytes(const uchar* from) {
  return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
}
inline __m128i sixteenBytes(const uchar* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}

/// The same sums as in blend(), eight pixels at a time: a shuffle, which compilers do not find by themselves,
/// picks their sources from the rows of a window. It gives 0 for bytes with the highest bit (kNextRow) set,
/// so each pixel takes the rows that are its own.
__attribute__((target("avx2"))) void blendWindows(const cv::Mat& raw, const SourceWindow* windows, int count,
                                                  const uchar* mask, uchar* out) {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(raw.step);
  const __m128i pixel_and_right = _mm_set1_epi16(0x0100);
  const __m128i other_row = _mm_set1_epi8(static_cast<char>(SourceWindow::kNextRow));
  const __m128i one = _mm_set1_epi8(kOne);
  const __m256i half = _mm256_set1_epi32(kOne * kOne / 2);
  for (int u = 0; u < count; u += SourceWindow::kPixels) {
    const int first = std::min(u, count - SourceWindow::kPixels);
    const SourceWindow& window = *windows++;
    if (window.x == SourceWindow::kNone) continue;
    const uchar* source = raw.data + window.y * step + window.x;
    const __m128i row0 = sixteenBytes(source), row1 = sixteenBytes(source + step),
                  row2 = sixteenBytes(source + 2 * step);
    const __m128i place = eightBytes(window.place.data()), right = eightBytes(window.right.data()),
                  below = eightBytes(window.below.data());
    const __m128i here = _mm_add_epi8(_mm_unpacklo_epi8(place, place), pixel_and_right);
    const __m128i next = _mm_xor_si128(here, other_row);
    const __m128i upper = _mm_or_si128(_mm_shuffle_epi8(row0, here), _mm_shuffle_epi8(row1, next));
    const __m128i lower = _mm_or_si128(_mm_shuffle_epi8(row1, here), _mm_shuffle_epi8(row2, next));
    const __m128i across = _mm_unpacklo_epi8(_mm_sub_epi8(one, right), right);
    const __m128i a = _mm_maddubs_epi16(upper, across), b = _mm_maddubs_epi16(lower, across);
    const __m256i pairs = _mm256_set_m128i(_mm_unpackhi_epi16(a, b), _mm_unpacklo_epi16(a, b));
    const __m256i down = _mm256_cvtepu8_epi16(_mm_unpacklo_epi8(_mm_sub_epi8(one, below), below));
    const __m256i sums = _mm256_add_epi32(_mm256_madd_epi16(pairs, down), half);
    static_assert(kOne * kOne == 1 << 10, "what is shifted out");
    const __m256i grey = _mm256_srli_epi32(sums, 10);
    const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(grey), _mm256_extracti128_si256(grey, 1));
    const __m128i bytes = _mm_and_si128(_mm_packus_epi16(words, words), eightBytes(mask + first));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out + first), bytes);
  }
}
#else
bool hasShuffle() { return false; }
void blendWindows(const cv::Mat&, const SourceWindow*, int, const uchar*, uchar*) {}
#endif

}  // namespace

Resampler::Resampler(const cv::Mat& map1, const cv::Mat& map2, const cv::Mat& mask, cv::Size source)
    : places_(map1.clone()), weights_(map2.clone()), mask_(mask) {
  keepInside(mask_, source, places_, weights_);
  if (hasShuffle() && source.width >= SourceWindow::kColumns && source.height >= SourceWindow::kRows &&
      mask_.cols >= SourceWindow::kPixels)
    findWindows(source);
}

void Resampler::findWindows(cv::Size source) {
  for (int v = 0; v < mask_.rows; ++v)
    for (int u = 0; u < mask_.cols; u += SourceWindow::kPixels) {
      const int first = std::min(u, mask_.cols - SourceWindow::kPixels);
      windows_.push_back(windowOf(first, v, source));
      if (windows_.back().x == SourceWindow::kNone) apart_.emplace_back(first, v);
    }
  windows_per_row_ = windows_.size() / mask_.rows;
}

SourceWindow Resampler::windowOf(int u, int v, cv::Size source) const {
  const cv::Vec2s* places = places_.ptr<cv::Vec2s>(v) + u;
  const std::uint16_t* weights = weights_.ptr<std::uint16_t>(v) + u;
  const uchar* mask = mask_.ptr<uchar>(v) + u;
  // Pixels that the mask leaves out may come from anywhere.
  int left = source.width - SourceWindow::kColumns, right = 0, top = source.height - SourceWindow::kRows,
      bottom = 0;
  for (int i = 0; i < SourceWindow::kPixels; ++i) {
    if (mask[i] == 0) continue;
    left = std::min<int>(left, places[i][0]);
    right = std::max<int>(right, places[i][0]);
    top = std::min<int>(top, places[i][1]);
    bottom = std::max<int>(bottom, places[i][1]);
  }
  SourceWindow window;
  if (right + 1 >= left + SourceWindow::kColumns || bottom + 1 >= top + SourceWindow::kRows) return window;
  window.x = static_cast<short>(left);
  window.y = static_cast<short>(top);
  for (int i = 0; i < SourceWindow::kPixels; ++i) {
    if (mask[i] == 0) continue;
    window.place[i] =
        static_cast<uchar>(places[i][0] - left + (places[i][1] > top ? SourceWindow::kNextRow : 0));
    window.right[i] = static_cast<uchar>(weights[i] & 255);
    window.below[i] = static_cast<uchar>(weights[i] >> 8);
  }
  return window;
}

void Resampler::resampleRun(const cv::Mat& raw, const cv::Point& first, int count, cv::Mat& out) const {
  static thread_local std::vector<int> offsets;
  static thread_local std::vector<std::uint16_t> upper, lower;
  offsets.resize(count);
  upper.resize(count);
  lower.resize(count);
  const auto [u, v] = std::make_pair(first.x, first.y);
  findOffsets(places_.ptr<short>(v) + 2 * static_cast<std::ptrdiff_t>(u), count, static_cast<int>(raw.step),
              offsets.data());
  gather(raw.data, offsets.data(), count, upper.data());
  gather(raw.data + raw.step, offsets.data(), count, lower.data());
  blend(upper.data(), lower.data(), weights_.ptr<std::uint16_t>(v) + u, mask_.ptr<uchar>(v) + u, count,
        out.ptr<uchar>(v) + u);
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
  for (const cv::Point& first : apart_) resampleRun(raw, first, SourceWindow::kPixels, out);
}

}  // namespace uav_landing
