#include "image/resampler.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "kernels/lanes/multiversion.h"
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

inline __m128i sixteenBytes(const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); }
__attribute__((target("avx2"))) inline __m256i halves(const uchar* first, const uchar* second) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(sixteenBytes(first)), sixteenBytes(second), 1);
}
__attribute__((target("avx2"))) inline __m256i words(const std::array<uchar, SourceWindows::kPixels>& bytes) {
  return _mm256_cvtepu8_epi16(sixteenBytes(bytes.data()));
}

/// The same sums as in blend(), sixteen pixels at a time: a shuffle, which compilers do not find by
/// themselves, picks the sources of each half from the rows of its window. It gives 0 for bytes with the
/// highest bit (kNextRow) set, so each pixel takes the rows that are its own.
__attribute__((target("avx2"))) void blendWindows(const cv::Mat& raw, const SourceWindows* windows, int count,
                                                  const uchar* mask, uchar* out) {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(raw.step);
  const __m256i both = _mm256_set1_epi16(0x0101), and_right = _mm256_set1_epi16(0x0100);
  const __m256i other_row = _mm256_set1_epi8(static_cast<char>(SourceWindows::kNextRow));
  const __m256i one = _mm256_set1_epi16(kOne), right_less_left = _mm256_set1_epi16(0x0100 - 1);
  const __m256i half = _mm256_set1_epi32(kOne * kOne / 2);
  for (int u = 0; u < count; u += SourceWindows::kPixels) {
    const int first = std::min(u, count - SourceWindows::kPixels);
    const SourceWindows& window = *windows++;
    const uchar* near = raw.data + window.y[0] * step + window.x[0];
    const uchar* far = raw.data + window.y[1] * step + window.x[1];
    const __m256i row0 = halves(near, far), row1 = halves(near + step, far + step),
                  row2 = halves(near + 2 * step, far + 2 * step);
    const __m256i here = _mm256_add_epi16(_mm256_mullo_epi16(words(window.place), both), and_right);
    const __m256i next = _mm256_xor_si256(here, other_row);
    const __m256i upper = _mm256_or_si256(_mm256_shuffle_epi8(row0, here), _mm256_shuffle_epi8(row1, next));
    const __m256i lower = _mm256_or_si256(_mm256_shuffle_epi8(row1, here), _mm256_shuffle_epi8(row2, next));
    // The weight of the right pixel in the upper byte, what is left of one in the lower.
    const __m256i across = _mm256_add_epi16(_mm256_mullo_epi16(words(window.right), right_less_left), one);
    const __m256i a = _mm256_maddubs_epi16(upper, across), b = _mm256_maddubs_epi16(lower, across);
    const __m256i below = words(window.below), above = _mm256_sub_epi16(one, below);
    const auto grey = [half](__m256i pairs, __m256i down) __attribute__((target("avx2"))) {
      static_assert(kOne * kOne == 1 << 10, "what is shifted out");
      return _mm256_srli_epi32(_mm256_add_epi32(_mm256_madd_epi16(pairs, down), half), 10);
    };
    const __m256i greys =
        _mm256_packus_epi32(grey(_mm256_unpacklo_epi16(a, b), _mm256_unpacklo_epi16(above, below)),
                            grey(_mm256_unpackhi_epi16(a, b), _mm256_unpackhi_epi16(above, below)));
    const __m256i bytes = _mm256_permute4x64_epi64(_mm256_packus_epi16(greys, greys), 0x08);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + first),
                     _mm_and_si128(_mm256_castsi256_si128(bytes), sixteenBytes(mask + first)));
  }
}
#else
bool hasShuffle() { return false; }
void blendWindows(const cv::Mat&, const SourceWindows*, int, const uchar*, uchar*) {}
#endif

}  // namespace

Resampler::Resampler(const cv::Mat& map1, const cv::Mat& map2, const cv::Mat& mask, cv::Size source)
    : places_(map1.clone()), weights_(map2.clone()), mask_(mask) {
  keepInside(mask_, source, places_, weights_);
  if (hasShuffle() && source.width >= SourceWindows::kColumns && source.height >= SourceWindows::kRows &&
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
  // Pixels that the mask leaves out may come from anywhere.
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
  for (const cv::Point& first : apart_) resampleRun(raw, first, SourceWindows::kHalf, out);
}

}  // namespace uav_landing
