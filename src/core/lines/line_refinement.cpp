#include "lines/line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

#include "base/multiversion.h"
#include "lines/line_fit.h"

namespace uav_landing {

using namespace line_fit;

namespace {

constexpr int kRadius = 3;  // px to both sides, first pass
constexpr int kMinStations = 6;
constexpr int kFewStations = 80;  // looked at in the first pass, roughly: fewer are led astray by heavy noise
constexpr double kMinSupport = 0.6;  // share of stations that must show the edge
constexpr double kMaxScatter = 0.6;  // px, 1 sigma of the peaks; more is no straight edge
constexpr int kGrowStep = 2;         // rows or columns
constexpr int kMaxMisses = 2;        // steps without edge at which a growing line ends

/// A vector's parts along the image axis that a line runs along, and along the other one.
struct Parts {
  double major, minor;

  Parts(const Eigen::Vector2d& v, const Axis& axis) : major(v[axis.major]), minor(v[axis.minor]) {}
  double dot(double other_major, double other_minor) const {
    return major * other_major + minor * other_minor;
  }
};

/// The pixels across a line at a station, along the station's row or column. Looks at whole pixels only:
/// interpolating between them biases the peak by up to 0.1 px.
struct Station {
  int centre;         ///< column or row of the pixel nearest to the line
  const uchar* grey;  ///< that pixel among those across the line; null outside image and ground

  /// Twice the gradient along the row or column, k pixels from the line; |k| <= kRadius.
  int twiceGradient(int k) const { return grey[k + 1] - grey[k - 1]; }
  /// The same for all k in turn; the last number is of nothing.
  cv::v_int16x8 twiceGradients() const {
    static_assert(2 * kRadius + 2 == cv::v_int16x8::nlanes, "fit into one register");
    const uchar* first = grey - (kRadius + 1);
    return cv::v_rotate_right<1>(cv::v_reinterpret_as_s16(cv::v_load_expand(first + 1))) -
           cv::v_reinterpret_as_s16(cv::v_load_expand(first));
  }
};

/// For those numbers: how far each is from the last one that is at most kEnd away, and of the others
/// something that no gradient makes up for.
template <int kEnd>
cv::v_int16x8 placesUpTo() {
  constexpr short kNever = -30000;
  const auto of = [](int i) {
    return std::abs(i - kRadius) <= kEnd ? static_cast<short>(kRadius + kEnd - i) : kNever;
  };
  return {of(0), of(1), of(2), of(3), of(4), of(5), of(6), kNever};
}

/// The strongest one of the gradients across a line at a station: twice itself and its neighbours.
struct Edge {
  int station, place;  ///< row and column, or the other way round
  int twice, before, after;
};

/// Edges along a line by columns, filled up to whole lanes.
struct EdgeColumns {
  using Column = std::array<int, std::tuple_size<Values>::value>;
  int count = 0;
  Column station, place, twice, before, after;

  void add(const Edge& edge) {
    set(count, edge);
    ++count;
  }
  void pad() {
    for (int i = count; i < wholeLanes(count); ++i) set(i, {0, 0, 1, 0, 0});
  }

 private:
  void set(int i, const Edge& edge) {
    station[i] = edge.station;
    place[i] = edge.place;
    twice[i] = edge.twice;
    before[i] = edge.before;
    after[i] = edge.after;
  }
};

/// A line's axes, and what gradients along rows or columns are across it.
struct LineFrame {
  Parts origin, along, across;
  double scale;  ///< grey/px, positive when brighter `across`, of one grey level along a row or column

  explicit LineFrame(const Axis& axis)
      : origin(axis.origin, axis),
        along(axis.along, axis),
        across(axis.across, axis),
        scale(0.5 / across.minor) {}

  /// Interpolated by a parabola.
  [[gnu::always_inline]] inline Peak peakOf(const Edge& edge) const {
    const double top = 0.5 * (edge.before - edge.after) / (edge.before - 2 * edge.twice + edge.after);
    const double major = edge.station - origin.major, minor = edge.place + top - origin.minor;
    return {along.dot(major, minor), across.dot(major, minor), std::abs(scale) * edge.twice};
  }
};

UAV_LANDING_MULTIVERSION void findPeaks(const EdgeColumns& edges, const LineFrame& frame, Peaks& peaks) {
  const LineFrame line = frame;
  for (int i = 0; i < wholeLanes(edges.count); ++i) {
    const Peak peak =
        line.peakOf({edges.station[i], edges.place[i], edges.twice[i], edges.before[i], edges.after[i]});
    peaks.along[i] = static_cast<float>(peak.along);
    peaks.across[i] = static_cast<float>(peak.across);
    peaks.gradient[i] = static_cast<float>(peak.gradient);
  }
  peaks.count = edges.count;
}

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// Looks along one line.
class EdgeSampler {
 public:
  EdgeSampler(const EdgePicture& picture, const Axis& axis, const EdgeKind& kind)
      : EdgeSampler(axis.minor == 0 ? picture.image : picture.transposed, picture.ground, axis, kind) {}

  const Axis& axis() const { return axis_; }
  const LineFrame& frame() const { return frame_; }

  Station at(int station) const {
    const int centre = cvRound(first_ + slope_ * station);
    constexpr int kReach = kRadius + 1;
    const bool inside = centre >= kReach && centre < size_ - kReach && station >= 0 && station < stations_ &&
                        ground_[station * to_next_station_ + centre * to_neighbour_] != 0;
    return {centre, inside ? pixels_ + station * step_ + centre : nullptr};
  }

  /// The strongest gradient within kReach px of the line; false when there is none of this kind.
  template <int kReach>
  bool findEdge(int station, Edge& edge) const {
    const Station sample = at(station);
    if (sample.grey == nullptr) return false;
    constexpr int kEnd = kReach + 1;
    static_assert(2 * kEnd < kBase && kReach < kRadius, "the place fits below");
    // Of two that are as strong the first: its place is in the lowest bits.
    const cv::v_int16x8 coded =
        cv::v_mul_wrap(sample.twiceGradients(), cv::v_setall_s16(factor_)) + placesUpTo<kEnd>();
    const int i = kRadius + kEnd - (cv::v_reduce_max(coded) & (kBase - 1)), k = i - kRadius;
    alignas(16) std::array<short, cv::v_int16x8::nlanes> strengths;
    cv::v_store_aligned(strengths.data(), coded >> kBits);
    if (std::abs(k) == kEnd || std::abs(frame_.scale) * strengths[i] < min_gradient_) return false;
    edge = {station, sample.centre + k, strengths[i], strengths[i - 1], strengths[i + 1]};
    return true;
  }

 private:
  static constexpr int kBits = 4, kBase = 1 << kBits;  // for the places of gradients

  /// pixels: with a row for each station.
  EdgeSampler(const cv::Mat& pixels, const cv::Mat& ground, const Axis& axis, const EdgeKind& kind)
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
        min_gradient_(kind.min_gradient),
        factor_(static_cast<short>(kind.sign * frame_.scale >= 0 ? kBase : -kBase)) {}

  const uchar *pixels_, *ground_;
  std::ptrdiff_t step_, to_next_station_, to_neighbour_;  // step_: of pixels_; the others: in ground_
  int size_, stations_;                                   // columns and rows of pixels_
  const Axis& axis_;
  LineFrame frame_;
  double slope_, first_;  // of the line: px across by station, and where it crosses station 0
  double min_gradient_;   // grey/px
  short factor_;          // kBase, or less than 0 for edges that are darker `across`
};

/// Peaks at so many rows or columns, or all, between two distances along the line.
template <int kReach>
void collect(const EdgeSampler& sampler, double from, double to, int most, Peaks& peaks) {
  const Axis& axis = sampler.axis();
  const int first = static_cast<int>(std::ceil(axis.point(from)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(to)[axis.major]));
  const int step = std::max(1, (last - first) / most);
  peaks.stations = 0;
  EdgeColumns edges;
  Edge edge;
  for (int station = first; station <= last; station += step) {
    ++peaks.stations;
    if (sampler.findEdge<kReach>(station, edge)) edges.add(edge);
  }
  edges.pad();
  findPeaks(edges, sampler.frame(), peaks);
}

/// How far the edge goes on beyond `from`, in steps of this many rows or columns.
double grow(const EdgeSampler& sampler, double from, int step) {
  const Axis& axis = sampler.axis();
  double end = from;
  int misses = 0;
  for (int station = cvRound(axis.point(from)[axis.major]) + step; misses < kMaxMisses; station += step) {
    Edge edge;
    const bool is_edge = sampler.findEdge<1>(station, edge);
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

/// Sign of the edge: the one of which more gradient is found along the line.
int edgeSign(const EdgeSampler& sampler, double half) {
  const Axis& axis = sampler.axis();
  double sum = 0;
  const int first = cvRound(axis.point(-half)[axis.major]), last = cvRound(axis.point(half)[axis.major]);
  const int step = std::max(1, (last - first) / 16);
  for (int station = first; station <= last; station += step)
    if (const Station sample = sampler.at(station); sample.grey != nullptr) {
      int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
      for (int k = 1 - kRadius; k < kRadius; ++k) {
        lowest = std::min(lowest, sample.twiceGradient(k));
        highest = std::max(highest, sample.twiceGradient(k));
      }
      sum += sampler.frame().scale * (highest + lowest);
    }
  return sum >= 0 ? 1 : -1;
}

}  // namespace

LineSegment makeLineSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset_stddev,
                            double angle_stddev) {
  const Eigen::Vector2d along = (b - a).normalized(), across(-along.y(), along.x());
  return {a, b, {across.x(), across.y(), -across.dot(0.5 * (a + b))}, offset_stddev, angle_stddev};
}

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
  collect<2>(EdgeSampler(picture, axis, kind), from, to, kFewStations, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit coarse = fitRobustly(peaks, scale);
  if (!isLine()) return std::nullopt;

  axis =
      Axis(axis.point(coarse.centre) + coarse.offset * axis.across, axis.along + coarse.slope * axis.across);
  const EdgeSampler sampler(picture, axis, kind);
  from = grow(sampler, from - coarse.centre, -kGrowStep);
  to = grow(sampler, to - coarse.centre, kGrowStep);
  collect<1>(sampler, from, to, kMaxStations, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit fit = refit(peaks, scale);
  if (!isLine()) return std::nullopt;
  return segmentOf(axis, peaks, fit, kind.sign);
}

}  // namespace uav_landing
