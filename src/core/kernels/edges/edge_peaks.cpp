#include "kernels/edges/edge_peaks.h"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr int kAtOnce = cv::v_int16x8::nlanes;  // stations
constexpr int kRadius = 3;                      // px from the centre up to which there are gradients
static_assert(kAtOnce == EdgeColumns::kAtOnce && EdgeColumns::kMost % kAtOnce == 0 && kAtOnce % kLanes == 0,
              "whole groups");

// Pixels k of eight rows, in column k, from the offset on.
[[gnu::always_inline]] inline void loadColumns(const uchar* const* rows, int offset,
                                               std::array<cv::v_int16x8, kAtOnce>& columns) {
  // Interleaving the upper half of the rows with the lower half three times turns rows into columns.
  std::array<cv::v_uint8x16, kAtOnce> row;
  std::array<cv::v_uint8x16, kAtOnce / 2> two, four, eight;
  for (int i = 0; i < kAtOnce; ++i) row[i] = cv::v_load_low(rows[i] + offset);
  cv::v_uint8x16 empty;
  for (int i = 0; i < kAtOnce / 2; ++i) cv::v_zip(row[i], row[i + kAtOnce / 2], two[i], empty);
  for (int i = 0; i < 2; ++i) cv::v_zip(two[i], two[i + 2], four[2 * i], four[2 * i + 1]);
  for (int i = 0; i < 2; ++i) cv::v_zip(four[i], four[i + 2], eight[2 * i], eight[2 * i + 1]);
  for (int i = 0; i < kAtOnce / 2; ++i) {
    cv::v_uint16x8 even, odd;
    cv::v_expand(eight[i], even, odd);
    columns[2 * i] = cv::v_reinterpret_as_s16(even);
    columns[2 * i + 1] = cv::v_reinterpret_as_s16(odd);
  }
}

// Twice the gradients about pixels at eight stations, from one end of each to the other.
template <size_t kGradients>
[[gnu::always_inline]] inline void loadGradients(const uchar* const* pixels,
                                                 std::array<cv::v_int16x8, kGradients>& gradients) {
  constexpr int kFirst = -static_cast<int>(kGradients / 2) - 1;  // pixel
  static_assert(kGradients + 1 <= kAtOnce, "one pixel more than fits at most");
  std::array<cv::v_int16x8, kAtOnce> columns, shifted;
  loadColumns(pixels, kFirst, columns);
  for (size_t k = 0; k < std::min<size_t>(kGradients, kAtOnce - 2); ++k)
    gradients[k] = columns[k + 2] - columns[k];
  if (kGradients + 2 <= kAtOnce) return;
  loadColumns(pixels, kFirst + 1, shifted);
  gradients[kGradients - 1] = shifted[kAtOnce - 1] - columns[kAtOnce - 2];
}

// Finds edges of one sign among the gradients within kReach px of pixels at eight stations.
template <int kReach>
[[gnu::always_inline]] inline void findStrongest(const uchar* const* pixels, short sign, short least,
                                                 EdgeColumns& edges, int first) {
  constexpr int kEnd = kReach + 1, kGradients = 2 * kEnd + 1;
  constexpr short kBits = 4, kBase = 1 << kBits;
  static_assert(kGradients < kBase && kEnd <= kRadius, "the place fits below");
  std::array<cv::v_int16x8, kGradients> gradients, coded;
  loadGradients(pixels, gradients);
  // Among equal gradients the first one wins: its distance from the last one is in the lowest bits.
  const cv::v_int16x8 signs = cv::v_setall_s16(sign), factor = cv::v_setall_s16(kBase * sign);
  for (int k = 0; k < kGradients; ++k)
    coded[k] =
        cv::v_mul_wrap(gradients[k], factor) + cv::v_setall_s16(static_cast<short>(kGradients - 1 - k));
  cv::v_int16x8 strongest = coded[0];
  for (int k = 1; k < kGradients; ++k) strongest = cv::v_max(strongest, coded[k]);
  // At an end it is no maximum, because the gradient goes on growing.
  cv::v_int16x8 before = cv::v_setzero_s16(), after = before, found = before;
  for (int k = 1; k + 1 < kGradients; ++k) {
    const cv::v_int16x8 here = strongest == coded[k];
    found = found | here;
    before = before | (here & gradients[k - 1]);
    after = after | (here & gradients[k + 1]);
  }
  const cv::v_int16x8 twice = strongest >> kBits;
  found = found & (twice >= cv::v_setall_s16(least)) & cv::v_setall_s16(1);
  cv::v_store(&edges.place[first], cv::v_setall_s16(kEnd) - (strongest & cv::v_setall_s16(kBase - 1)));
  cv::v_store(&edges.twice[first], twice);
  cv::v_store(&edges.before[first], cv::v_mul_wrap(before, signs));
  cv::v_store(&edges.after[first], cv::v_mul_wrap(after, signs));
  cv::v_store(&edges.found[first], found);
}

template <int kReach>
UAV_LANDING_MULTIVERSION void findEdgesWithin(const uchar* const* pixels, int stations, short sign,
                                              short least, EdgeColumns& edges) {
  for (int i = 0; i < stations; i += kAtOnce) findStrongest<kReach>(&pixels[i], sign, least, edges, i);
}

}  // namespace

UAV_LANDING_MULTIVERSION void setCentres(const Stations& stations, double first, double slope,
                                         EdgeColumns& edges) {
  // Adding and subtracting a number without room for a fraction rounds as cvRound() does.
  constexpr double kRounding = 6755399441055744.0;  // 1.5 * 2^52
  const Stations at = stations;
  for (int i = 0; i < wholeLanes(at.count); ++i)
    edges.centre[i] = static_cast<int>((first + slope * at.at(i) + kRounding) - kRounding);
}

void findEdges(const uchar* const* pixels, int stations, int reach, short sign, short least,
               EdgeColumns& edges) {
  if (reach == 1) {
    findEdgesWithin<1>(pixels, stations, sign, least, edges);
  } else {
    findEdgesWithin<2>(pixels, stations, sign, least, edges);
  }
}

UAV_LANDING_MULTIVERSION void findPeaks(const EdgeColumns& edges, const Stations& stations,
                                        const LineAxes& axes, float* along, float* across, float* gradient) {
  const LineAxes line = axes;
  const Stations at = stations;
  for (int i = 0; i < wholeLanes(at.count); ++i) {
    const EdgePeak peak = line.peakOf(
        {at.at(i), edges.centre[i] + edges.place[i], edges.twice[i], edges.before[i], edges.after[i]});
    along[i] = static_cast<float>(peak.along);
    across[i] = static_cast<float>(peak.across);
    gradient[i] = static_cast<float>(peak.gradient);
  }
}

int keepFound(const EdgeColumns& edges, int stations, float* along, float* across, float* gradient) {
  std::ptrdiff_t kept = 0;
  while (kept < stations && edges.found[kept] != 0) ++kept;
  for (std::ptrdiff_t i = kept; i < stations; ++i) {
    along[kept] = along[i];
    across[kept] = across[i];
    gradient[kept] = gradient[i];
    kept += edges.found[i];
  }
  return static_cast<int>(kept);
}

}  // namespace uav_landing
