#include "lines/line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core/hal/intrin.hpp>

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
  int centre;                ///< column or row of the pixel nearest to the line
  const uchar* grey;         ///< of that pixel; null outside image and ground
  std::ptrdiff_t neighbour;  ///< from pixel to pixel across the line

  /// Twice the gradient along the row or column, k pixels from the line; |k| <= kRadius.
  int twiceGradient(int k) const { return grey[(k + 1) * neighbour] - grey[(k - 1) * neighbour]; }
};

/// Twice the gradients across a line at all pixels up to kRadius from this one, in turn; the last number is
/// of nothing.
cv::v_int16x8 gradientsAround(const uchar* pixel, std::ptrdiff_t neighbour) {
  static_assert(2 * kRadius + 2 == cv::v_int16x8::nlanes, "fit into one register");
  const uchar* p = pixel - (kRadius + 1) * neighbour;
  if (neighbour == 1) {
    const cv::v_int16x8 before = cv::v_reinterpret_as_s16(cv::v_load_expand(p));
    return cv::v_rotate_right<1>(cv::v_reinterpret_as_s16(cv::v_load_expand(p + 1))) - before;
  }
  const auto at = [&](int i) { return static_cast<short>(p[i * neighbour]); };
  const cv::v_int16x8 before(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7));
  return (cv::v_rotate_right<2>(before) | cv::v_int16x8(0, 0, 0, 0, 0, 0, at(8), 0)) - before;
}

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

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// Looks along one line.
class EdgeSampler {
 public:
  EdgeSampler(const cv::Mat& image, const cv::Mat& ground, const Axis& axis)
      : image_(image.ptr<uchar>()),
        ground_(ground.ptr<uchar>()),
        axis_(axis),
        origin_(axis.origin, axis),
        along_(axis.along, axis),
        across_(axis.across, axis),
        slope_(along_.minor / along_.major),
        first_(origin_.minor - slope_ * origin_.major),
        scale_(0.5 / across_.minor),
        size_(axis.minor == 0 ? image.cols : image.rows),
        stations_(axis.minor == 0 ? image.rows : image.cols),
        image_step_(axis, image),
        ground_step_(axis, ground) {}

  const Axis& axis() const { return axis_; }
  /// From twice the gradient along a row or column to that across the line, grey/px, positive when brighter
  /// `across`.
  double scale() const { return scale_; }

  Station at(int station) const {
    const int centre = cvRound(first_ + slope_ * station);
    constexpr int kReach = kRadius + 1;
    const bool inside = centre >= kReach && centre < size_ - kReach && station >= 0 && station < stations_ &&
                        ground_[ground_step_.to(station, centre)] != 0;
    return {centre, inside ? image_ + image_step_.to(station, centre) : nullptr, image_step_.minor};
  }

  /// The strongest gradient within kReach px of the line, interpolated by a parabola; false when there is
  /// none of this kind.
  template <int kReach>
  bool findPeak(int station, const EdgeKind& kind, Peak& peak) const {
    const Station sample = at(station);
    if (sample.grey == nullptr) return false;
    constexpr int kEnd = kReach + 1, kBits = 4, kBase = 1 << kBits;
    static_assert(2 * kEnd < kBase && kReach < kRadius, "the place fits below");
    // Of two that are as strong the first: its place is in the lowest bits.
    const short base = static_cast<short>(kind.sign * scale_ >= 0 ? kBase : -kBase);
    const cv::v_int16x8 coded =
        cv::v_mul_wrap(gradientsAround(sample.grey, sample.neighbour), cv::v_setall_s16(base)) +
        placesUpTo<kEnd>();
    const int i = kRadius + kEnd - (cv::v_reduce_max(coded) & (kBase - 1)), k = i - kRadius;
    alignas(16) std::array<short, cv::v_int16x8::nlanes> strengths;
    cv::v_store_aligned(strengths.data(), coded >> kBits);
    const int twice = strengths[i];
    const double gradient = std::abs(scale_) * twice;
    if (std::abs(k) == kEnd || gradient < kind.min_gradient) return false;
    const int before = strengths[i - 1], after = strengths[i + 1];
    const double top = 0.5 * (before - after) / (before - 2 * twice + after);
    const double major = station - origin_.major, minor = sample.centre + k + top - origin_.minor;
    peak = {along_.dot(major, minor), across_.dot(major, minor), gradient};
    return true;
  }

 private:
  struct Steps {
    std::ptrdiff_t major, minor;

    Steps(const Axis& axis, const cv::Mat& image)
        : major(axis.major == 0 ? 1 : static_cast<std::ptrdiff_t>(image.step)),
          minor(axis.minor == 0 ? 1 : static_cast<std::ptrdiff_t>(image.step)) {}
    std::ptrdiff_t to(int station, int place) const { return station * major + place * minor; }
  };

  const uchar *image_, *ground_;
  const Axis& axis_;
  Parts origin_, along_, across_;
  double slope_, first_;  // of the line: px across by station, and where it crosses station 0
  double scale_;
  int size_, stations_;  // of the image, across and along
  Steps image_step_, ground_step_;
};

/// Peaks at so many rows or columns, or all, between two distances along the line.
template <int kReach>
void collect(const EdgeSampler& sampler, double from, double to, int most, const EdgeKind& kind,
             Peaks& peaks) {
  const Axis& axis = sampler.axis();
  const int first = static_cast<int>(std::ceil(axis.point(from)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(to)[axis.major]));
  const int step = std::max(1, (last - first) / most);
  peaks.stations = peaks.count = 0;
  Peak peak;
  for (int station = first; station <= last; station += step) {
    ++peaks.stations;
    if (sampler.findPeak<kReach>(station, kind, peak)) peaks.add(peak);
  }
}

/// How far the edge goes on beyond `from`, in steps of this many rows or columns.
double grow(const EdgeSampler& sampler, double from, int step, const EdgeKind& kind) {
  const Axis& axis = sampler.axis();
  double end = from;
  int misses = 0;
  for (int station = cvRound(axis.point(from)[axis.major]) + step; misses < kMaxMisses; station += step) {
    Peak peak;
    if (sampler.findPeak<1>(station, kind, peak) && std::abs(peak.across) < 1) {
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
      sum += sampler.scale() * (highest + lowest);
    }
  return sum >= 0 ? 1 : -1;
}

}  // namespace

LineSegment makeLineSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double offset_stddev,
                            double angle_stddev) {
  const Eigen::Vector2d along = (b - a).normalized(), across(-along.y(), along.x());
  return {a, b, {across.x(), across.y(), -across.dot(0.5 * (a + b))}, offset_stddev, angle_stddev};
}

Eigen::Vector2d brighterSide(const cv::Mat& image, const cv::Mat& ground, const Eigen::Vector2d& a,
                             const Eigen::Vector2d& b) {
  const Axis axis(0.5 * (a + b), b - a);
  return edgeSign(EdgeSampler(image, ground, axis), 0.5 * (b - a).norm()) * axis.across;
}

std::optional<LineSegment> refineLine(const cv::Mat& image, const cv::Mat& ground, const RoughSegment& rough,
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
  collect<2>(EdgeSampler(image, ground, axis), from, to, kFewStations, kind, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit coarse = fitRobustly(peaks, scale);
  if (!isLine()) return std::nullopt;

  axis =
      Axis(axis.point(coarse.centre) + coarse.offset * axis.across, axis.along + coarse.slope * axis.across);
  const EdgeSampler sampler(image, ground, axis);
  from = grow(sampler, from - coarse.centre, -kGrowStep, kind);
  to = grow(sampler, to - coarse.centre, kGrowStep, kind);
  collect<1>(sampler, from, to, kMaxStations, kind, peaks);
  if (peaks.count < kMinStations) return std::nullopt;
  const Fit fit = refit(peaks, scale);
  if (!isLine()) return std::nullopt;
  return segmentOf(axis, peaks, fit, kind.sign);
}

}  // namespace uav_landing
