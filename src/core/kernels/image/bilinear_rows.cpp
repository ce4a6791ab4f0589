#include "kernels/image/bilinear_rows.h"

#include <algorithm>
#include <cstring>

#include "kernels/lanes/multiversion.h"
#if defined(__x86_64__) && defined(__GNUC__)
#define UAV_LANDING_HAS_SHUFFLE
#include <immintrin.h>
#endif

namespace uav_landing {

namespace {

constexpr int kTogether = 256;  // pixels whose sources are gathered before they are mixed

/// Offsets in the source's memory of a row of places, each (x, y).
UAV_LANDING_MULTIVERSION void findOffsets(const short* __restrict places, int count, int step,
                                          int* __restrict offsets) {
  for (int u = 0; u < count; ++u) offsets[u] = places[2 * u + 1] * step + places[2 * u];
}

/// The two pixels from each offset on, the first one in the lower byte.
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
    const short left = static_cast<short>(kBilinearOne - right),
                above = static_cast<short>(kBilinearOne - below);
    const short a = static_cast<short>((upper[u] & 255) * left + (upper[u] >> 8) * right);
    const short b = static_cast<short>((lower[u] & 255) * left + (lower[u] >> 8) * right);
    const unsigned grey = static_cast<unsigned>(a * above + b * below + kBilinearOne * kBilinearOne / 2) /
                          (kBilinearOne * kBilinearOne);
    out[u] = static_cast<uchar>(grey & mask[u]);
  }
}

#ifdef UAV_LANDING_HAS_SHUFFLE
inline __m128i sixteenBytes(const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); }
__attribute__((target("avx2"))) inline __m256i halves(const uchar* first, const uchar* second) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(sixteenBytes(first)), sixteenBytes(second), 1);
}
__attribute__((target("avx2"))) inline __m256i words(const std::array<uchar, SourceWindows::kPixels>& bytes) {
  return _mm256_cvtepu8_epi16(sixteenBytes(bytes.data()));
}
#endif

}  // namespace

void blendRow(const cv::Mat& image, const PlacedRow& row, uchar* out) {
  std::array<int, kTogether> offsets;
  std::array<std::uint16_t, kTogether> upper, lower;
  for (int u = 0; u < row.count; u += kTogether) {
    const int count = std::min(kTogether, row.count - u);
    findOffsets(row.places + 2 * static_cast<std::ptrdiff_t>(u), count, static_cast<int>(image.step),
                offsets.data());
    gather(image.data, offsets.data(), count, upper.data());
    gather(image.data + image.step, offsets.data(), count, lower.data());
    blend(upper.data(), lower.data(), row.weights + u, row.mask + u, count, out + u);
  }
}

#ifdef UAV_LANDING_HAS_SHUFFLE
bool canBlendWindows() { return __builtin_cpu_supports("avx2") != 0; }

// The same sums as in blend(), sixteen pixels at a time. A shuffle, which compilers do not find by
// themselves, picks the sources of each half from the rows of its window. It gives 0 for bytes with the
// highest bit (kNextRow) set, so each pixel takes its own rows.
__attribute__((target("avx2"))) void blendWindows(const cv::Mat& image, const SourceWindows* windows,
                                                  int count, const uchar* mask, uchar* out) {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(image.step);
  const __m256i both = _mm256_set1_epi16(0x0101), and_right = _mm256_set1_epi16(0x0100);
  const __m256i other_row = _mm256_set1_epi8(static_cast<char>(SourceWindows::kNextRow));
  const __m256i one = _mm256_set1_epi16(kBilinearOne), right_less_left = _mm256_set1_epi16(0x0100 - 1);
  const __m256i half = _mm256_set1_epi32(kBilinearOne * kBilinearOne / 2);
  for (int u = 0; u < count; u += SourceWindows::kPixels) {
    const int first = std::min(u, count - SourceWindows::kPixels);
    const SourceWindows& window = *windows++;
    const uchar* near = image.data + window.y[0] * step + window.x[0];
    const uchar* far = image.data + window.y[1] * step + window.x[1];
    const __m256i row0 = halves(near, far), row1 = halves(near + step, far + step),
                  row2 = halves(near + 2 * step, far + 2 * step);
    const __m256i here = _mm256_add_epi16(_mm256_mullo_epi16(words(window.place), both), and_right);
    const __m256i next = _mm256_xor_si256(here, other_row);
    const __m256i upper = _mm256_or_si256(_mm256_shuffle_epi8(row0, here), _mm256_shuffle_epi8(row1, next));
    const __m256i lower = _mm256_or_si256(_mm256_shuffle_epi8(row1, here), _mm256_shuffle_epi8(row2, next));
    // The weight of the right pixel in the upper byte, one minus this weight in the lower.
    const __m256i across = _mm256_add_epi16(_mm256_mullo_epi16(words(window.right), right_less_left), one);
    const __m256i a = _mm256_maddubs_epi16(upper, across), b = _mm256_maddubs_epi16(lower, across);
    const __m256i below = words(window.below), above = _mm256_sub_epi16(one, below);
    const auto grey = [half](__m256i pairs, __m256i down) __attribute__((target("avx2"))) {
      static_assert(kBilinearOne * kBilinearOne == 1 << 10, "what is shifted out");
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
bool canBlendWindows() { return false; }
void blendWindows(const cv::Mat&, const SourceWindows*, int, const uchar*, uchar*) {}
#endif

}  // namespace uav_landing
