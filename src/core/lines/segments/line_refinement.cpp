#include "lines/segments/line_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lines/segments/edge_sampler.h"
#include "lines/segments/line_fit.h"

namespace uav_landing {

using namespace line_fit;

namespace {

constexpr int kMinStations = 6;
constexpr int kFewStations = 80;  // stations of the first pass, roughly; fewer are led astray by heavy noise
constexpr double kMinSupport = 0.6;  // share of the stations that must show the edge
constexpr double kMaxScatter = 0.6;  // px, 1 sigma of the peaks; an edge with more is not straight
constexpr int kGrowStep = 2;         // rows or columns
constexpr int kMaxMisses = 2;        // steps without an edge after which a line stops growing

/// Distance up to which the edge continues beyond `from`, in steps of this many rows or columns.
double grow(const EdgeSampler& sampler, double from, int step) {
  const Axis& axis = sampler.axis();
  double end = from;
  int misses = 0;
  for (int station = cvRound(axis.point(from)[axis.major]) + step; misses < kMaxMisses; station += step) {
    StationEdge edge;
    const bool is_edge = sampler.findEdge(station, edge);
    const Peak peak = is_edge ? sampler.frame().peakOf(edge) : Peak();
    if (is_edge && std::abs(peak.across) < 1) {
      end = peak.along;
      misses = 0;
    } else {
      ++misses;
    }
  }
  return end;
}

/// Sign of the edge: the one with more gradient along the line.
int edgeSign(const EdgeSampler& sampler, double half) {
  const Axis& axis = sampler.axis();
  double sum = 0;
  const int first = cvRound(axis.point(-half)[axis.major]), last = cvRound(axis.point(half)[axis.major]);
  const int step = std::max(1, (last - first) / 16);
  for (int station = first; station <= last; station += step)
    if (const Station sample = sampler.at(station); sample.grey != nullptr) {
      int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
      for (int k = 1 - Station::kRadius; k < Station::kRadius; ++k) {
        lowest = std::min(lowest, sample.twiceGradient(k));
        highest = std::max(highest, sample.twiceGradient(k));
      }
      sum += sampler.frame().scale * (highest + lowest);
    }
  return sum >= 0 ? 1 : -1;
}

}  // namespace

Eigen::Vector2d brighterSide(const EdgePicture& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Axis axis(0.5 * (a + b), b - a);
  return edgeSign(EdgeSampler(picture, axis, {1, 0}), 0.5 * (b - a).norm()) * axis.across;
}

std::optional<LineSegment> refineLine(const EdgePicture& picture, const RoughSegment& rough,
                                      double min_gradient) {
  Axis axis(0.5 * (rough.a + rough.b), rough.b - rough.a);
  double from = -0.5 * (rough.b - rough.a).norm(), to = -from;
  const EdgeKind kind{axis.across.dot(rough.brighter) >= 0 ? 1 : -1, min_gradient};
  Peaks peaks;
  double scale = 0;
  const auto isLine = [&] {
    const int used = peaks.used();
    return used >= kMinStations && used >= kMinSupport * peaks.stations && scale <= kMaxScatter;
  };
  EdgeSampler(picture, axis, kind).collect(2, from, to, kFewStations, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit coarse = fitRobustly(peaks, scale);
  if (!isLine()) return std::nullopt;

  axis =
      Axis(axis.point(coarse.centre) + coarse.offset * axis.across, axis.along + coarse.slope * axis.across);
  const EdgeSampler sampler(picture, axis, kind);
  from = grow(sampler, from - coarse.centre, -kGrowStep);
  to = grow(sampler, to - coarse.centre, kGrowStep);
  sampler.collect(1, from, to, kMaxStations, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit fit = refit(peaks, scale);
  if (!isLine()) return std::nullopt;
  return segmentOf(axis, peaks, fit, kind.sign);
}

}  // namespace uav_landing
