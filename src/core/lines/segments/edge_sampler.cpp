#include "lines/segments/edge_sampler.h"

#include <algorithm>
#include <array>

namespace uav_landing::line_fit {

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
      slope_(frame_.along_minor / frame_.along_major),
      first_(frame_.origin_minor - slope_ * frame_.origin_major),
      sign_(static_cast<short>(kind.sign * frame_.scale >= 0 ? 1 : -1)) {
  constexpr double kNever = 256;  // no difference of grey levels is as large
  least_ = static_cast<short>(std::ceil(std::min(kind.min_gradient / std::abs(frame_.scale), kNever)));
}

bool EdgeSampler::findEdge(int station, StationEdge& edge) const {
  const Station sample = at(station);
  if (sample.grey == nullptr) return false;
  const auto twice = [&](int k) { return sign_ * sample.twiceGradient(k); };
  constexpr int kEnd = 2;  // at the end it is no maximum, as the gradient goes on growing
  int k = -kEnd;
  for (int other = k + 1; other <= kEnd; ++other)
    if (twice(other) > twice(k)) k = other;
  if (std::abs(k) == kEnd || twice(k) < least_) return false;
  edge = {station, sample.centre + k, twice(k), twice(k - 1), twice(k + 1)};
  return true;
}

/// Those stations at which enough pixels across the line are in the image.
Stations EdgeSampler::inside(Stations stations) const {
  const auto is_inside = [&](int i) {
    return isInside(stations.at(i), cvRound(first_ + slope_ * stations.at(i)));
  };
  while (stations.count > 0 && !is_inside(stations.count - 1)) --stations.count;
  int first = 0;
  while (first < stations.count && !is_inside(first)) ++first;
  return {stations.at(first), stations.step, stations.count - first};
}

void EdgeSampler::collect(int reach, double from, double to, int most, Peaks& peaks) const {
  const int first = static_cast<int>(std::ceil(axis_.point(from)[axis_.major]));
  const int last = static_cast<int>(std::floor(axis_.point(to)[axis_.major]));
  const int step = std::max(1, (last - first) / most);
  peaks.stations = std::max(0, (last - first) / step + 1);
  const Stations stations = inside({first, step, peaks.stations});
  EdgeColumns edges;
  setCentres(stations, first_, slope_, edges);

  constexpr int kAtOnce = EdgeColumns::kAtOnce;
  static constexpr std::array<uchar, 2 * kAtOnce> kNothing = {};  // pixels without edges
  std::array<const uchar*, EdgeColumns::kMost> pixels;
  const uchar *row = pixels_ + stations.first * step_, *ground = ground_ + stations.first * to_next_station_;
  const std::ptrdiff_t to_next_row = stations.step * step_, to_next = stations.step * to_next_station_,
                       to_neighbour = to_neighbour_;
  for (int i = 0; i < stations.count; ++i, row += to_next_row, ground += to_next) {
    const std::ptrdiff_t centre = edges.centre[i];
    pixels[i] = ground[centre * to_neighbour] != 0 ? row + centre : &kNothing[kAtOnce];
  }
  for (int i = stations.count; i % kAtOnce != 0; ++i) pixels[i] = &kNothing[kAtOnce];

  findEdges(pixels.data(), stations.count, reach, sign_, least_, edges);
  findPeaks(edges, stations, frame_, peaks.along.data(), peaks.across.data(), peaks.gradient.data());
  peaks.count =
      keepFound(edges, stations.count, peaks.along.data(), peaks.across.data(), peaks.gradient.data());
}

}  // namespace uav_landing::line_fit
