#include "lines/edge_sampler.h"

#include <algorithm>
#include <array>
#include <opencv2/core/hal/intrin.hpp>
#include <tuple>

#include "kernels/lanes/multiversion.h"

namespace uav_landing::line_fit {

namespace {

constexpr int kAtOnce = cv::v_int16x8::nlanes;  // stations

/// Edges at stations along a line by columns, filled up to whole groups; where there is none the numbers mean
/// nothing.
struct EdgeColumns {
  static constexpr int kMost = std::tuple_size<Values>::value;
  static_assert(kMost % kAtOnce == 0 && kAtOnce % kLanes == 0, "whole groups");
  using Column = std::array<short, kMost>;

  std::array<int, kMost> centre;  ///< of the pixels across the line
  Column place;                   ///< from there
  Column twice, before, after;
  Column found;  ///< whether there is one: 1 or 0
};

/// Where a line (px across at station 0, and by station) crosses the stations.
UAV_LANDING_MULTIVERSION void setCentres(const Stations& stations, double first, double slope,
                                         EdgeColumns& edges) {
  // Adding and subtracting a number so large that there is no room for a fraction rounds as cvRound() does.
  constexpr double kRounding = 6755399441055744.0;  // 1.5 * 2^52
  const Stations at = stations;
  for (int i = 0; i < wholeLanes(at.count); ++i)
    edges.centre[i] = static_cast<int>((first + slope * at.at(i) + kRounding) - kRounding);
}

/// Of all stations, whether there is an edge or not.
UAV_LANDING_MULTIVERSION void findPeaks(const EdgeColumns& edges, const Stations& stations,
                                        const LineFrame& frame, Peaks& peaks) {
  const LineFrame line = frame;
  const Stations at = stations;
  for (int i = 0; i < wholeLanes(at.count); ++i) {
    const Peak peak = line.peakOf(
        {at.at(i), edges.centre[i] + edges.place[i], edges.twice[i], edges.before[i], edges.after[i]});
    peaks.along[i] = static_cast<float>(peak.along);
    peaks.across[i] = static_cast<float>(peak.across);
    peaks.gradient[i] = static_cast<float>(peak.gradient);
  }
}

/// Leaves out the stations without an edge.
void keepFound(const EdgeColumns& edges, int stations, Peaks& peaks) {
  std::ptrdiff_t kept = 0;
  while (kept < stations && edges.found[kept] != 0) ++kept;
  for (std::ptrdiff_t i = kept; i < stations; ++i) {
    peaks.along[kept] = peaks.along[i];
    peaks.across[kept] = peaks.across[i];
    peaks.gradient[kept] = peaks.gradient[i];
    kept += edges.found[i];
  }
  peaks.count = static_cast<int>(kept);
}

/// Column k of eight rows of eight pixels each: pixel k of all of them, from the offset on.
[[gnu::always_inline]] inline void loadColumns(const uchar* const* rows, int offset,
                                               std::array<cv::v_int16x8, kAtOnce>& columns) {
  // Interleaving the upper half of the rows with the lower one three times turns rows into columns.
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

/// Twice the gradients about pixels at eight stations, of each from one end to the other.
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

/// Finds edges of one sign among the gradients within kReach px of pixels at eight stations.
template <int kReach>
[[gnu::always_inline]] inline void findStrongest(const uchar* const* pixels, short sign, short least,
                                                 EdgeColumns& edges, int first) {
  constexpr int kEnd = kReach + 1, kGradients = 2 * kEnd + 1;
  constexpr short kBits = 4, kBase = 1 << kBits;
  static_assert(kGradients < kBase && kEnd <= Station::kRadius, "the place fits below");
  std::array<cv::v_int16x8, kGradients> gradients, coded;
  loadGradients(pixels, gradients);
  // Of two that are as strong the first: how far it is from the last is in the lowest bits.
  const cv::v_int16x8 signs = cv::v_setall_s16(sign), factor = cv::v_setall_s16(kBase * sign);
  for (int k = 0; k < kGradients; ++k)
    coded[k] =
        cv::v_mul_wrap(gradients[k], factor) + cv::v_setall_s16(static_cast<short>(kGradients - 1 - k));
  cv::v_int16x8 strongest = coded[0];
  for (int k = 1; k < kGradients; ++k) strongest = cv::v_max(strongest, coded[k]);
  // At an end it is no maximum, but goes on growing.
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

/// Of all stations, filled up to whole groups.
template <int kReach>
UAV_LANDING_MULTIVERSION void findEdges(const uchar* const* pixels, int stations, short sign, short least,
                                        EdgeColumns& edges) {
  for (int i = 0; i < stations; i += kAtOnce) findStrongest<kReach>(&pixels[i], sign, least, edges, i);
}

}  // namespace

EdgeSampler::EdgeSampler(const cv::Mat& pixels, const cv::Mat& ground, const Axis& axis, const EdgeKind& kind)
    : pixels_(pixels.ptr<uchar>()),
      ground_(ground.ptr<uchar>()),
      step_(static_cast<std::ptrdiff_t>(pixels.step)),
      to_next_station_(axis.minor == 0 ? static_cast<std::ptrdiff_t>(ground.step) : 1),
      to_neighbour_(axis.minor == 0 ? 1 : static_cast<std::ptrdiff_t>(ground.step)),
      size_(pixels.cols),
      stations_(pixels.rows),
      axis_(axis),
      frame_(axis),
      slope_(frame_.along.minor / frame_.along.major),
      first_(frame_.origin.minor - slope_ * frame_.origin.major),
      sign_(static_cast<short>(kind.sign * frame_.scale >= 0 ? 1 : -1)) {
  constexpr double kNever = 256;  // no difference of grey levels
  least_ = static_cast<short>(std::ceil(std::min(kind.min_gradient / std::abs(frame_.scale), kNever)));
}

bool EdgeSampler::findEdge(int station, Edge& edge) const {
  const Station sample = at(station);
  if (sample.grey == nullptr) return false;
  const auto twice = [&](int k) { return sign_ * sample.twiceGradient(k); };
  constexpr int kEnd = 2;  // there it is no maximum, but goes on growing
  int k = -kEnd;
  for (int other = k + 1; other <= kEnd; ++other)
    if (twice(other) > twice(k)) k = other;
  if (std::abs(k) == kEnd || twice(k) < least_) return false;
  edge = {station, sample.centre + k, twice(k), twice(k - 1), twice(k + 1)};
  return true;
}

/// Those from which enough pixels across the line are in the image.
Stations EdgeSampler::inside(Stations stations) const {
  const auto is_inside = [&](int i) {
    return isInside(stations.at(i), cvRound(first_ + slope_ * stations.at(i)));
  };
  while (stations.count > 0 && !is_inside(stations.count - 1)) --stations.count;
  int first = 0;
  while (first < stations.count && !is_inside(first)) ++first;
  return {stations.at(first), stations.step, stations.count - first};
}

template <int kReach>
void EdgeSampler::collect(double from, double to, int most, Peaks& peaks) const {
  const int first = static_cast<int>(std::ceil(axis_.point(from)[axis_.major]));
  const int last = static_cast<int>(std::floor(axis_.point(to)[axis_.major]));
  const int step = std::max(1, (last - first) / most);
  peaks.stations = std::max(0, (last - first) / step + 1);
  const Stations stations = inside({first, step, peaks.stations});
  EdgeColumns edges;
  setCentres(stations, first_, slope_, edges);

  static constexpr std::array<uchar, 2 * kAtOnce> kNothing = {};  // no edges
  std::array<const uchar*, EdgeColumns::kMost> pixels;
  const uchar *row = pixels_ + stations.first * step_, *ground = ground_ + stations.first * to_next_station_;
  const std::ptrdiff_t to_next_row = stations.step * step_, to_next = stations.step * to_next_station_,
                       to_neighbour = to_neighbour_;
  for (int i = 0; i < stations.count; ++i, row += to_next_row, ground += to_next) {
    const std::ptrdiff_t centre = edges.centre[i];
    pixels[i] = ground[centre * to_neighbour] != 0 ? row + centre : &kNothing[kAtOnce];
  }
  for (int i = stations.count; i % kAtOnce != 0; ++i) pixels[i] = &kNothing[kAtOnce];

  findEdges<kReach>(pixels.data(), stations.count, sign_, least_, edges);
  findPeaks(edges, stations, frame_, peaks);
  keepFound(edges, stations.count, peaks);
}

template void EdgeSampler::collect<1>(double, double, int, Peaks&) const;
template void EdgeSampler::collect<2>(double, double, int, Peaks&) const;

}  // namespace uav_landing::line_fit
