#include "line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace uav_landing {

namespace {

constexpr int kRadius = 3;         // px to both sides, first pass
constexpr int kMaxStations = 160;  // rows or columns looked at, roughly; a longer line skips some
constexpr int kMinStations = 6;
constexpr double kMinSupport = 0.6;    // share of stations that must show the edge
constexpr double kMaxScatter = 0.6;    // px, 1 sigma of the peaks; more is no straight edge
constexpr double kOffsetFloor = 0.03;  // px: pixel grid, fixed-point maps, lens model
constexpr int kGrowStep = 2;           // rows or columns
constexpr int kMaxMisses = 2;          // steps without edge at which a growing line ends
constexpr double kMinScale = 0.05;     // px, scale of the robust weights

/// Where the edge is at one station: distances along and across the current line, px, and its gradient,
/// grey/px.
struct Peak {
  double along, across, gradient;
};

/// Of a value at each station; in the memory of the function that has it.
using Values = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, 2 * kMaxStations, 1>;

/// The peaks along a line and their weights.
struct Peaks {
  int stations = 0;  ///< that were looked at
  Values along, across, gradient, weight;

  int size() const { return static_cast<int>(along.size()); }
  /// Keeps what is there.
  void resize(int size) {
    along.conservativeResize(size);
    across.conservativeResize(size);
    gradient.conservativeResize(size);
    weight.resize(size);
  }
  void set(int i, const Peak& peak) {
    along[i] = peak.along;
    across[i] = peak.across;
    gradient[i] = peak.gradient;
  }
};

/// Frame of a line: origin, direction along and (across) 90 degrees clockwise in the picture. Along points
/// down, or to the right when the line is flat, so that stations are whole rows or columns in rising order.
struct Axis {
  Eigen::Vector2d origin, along, across;
  int major, minor;  ///< image axis that the line runs along, and the other: 0 u, 1 v

  Axis(const Eigen::Vector2d& point, const Eigen::Vector2d& direction)
      : origin(point), along(direction.normalized()) {
    major = std::abs(along.y()) >= std::abs(along.x()) ? 1 : 0;
    minor = 1 - major;
    if (along[major] < 0) along = -along;
    across = {-along.y(), along.x()};
  }
  Eigen::Vector2d point(double distance) const { return origin + distance * along; }
};

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
  int number;                ///< row or column
  int centre;                ///< column or row of the pixel nearest to the line
  const uchar* grey;         ///< of that pixel
  std::ptrdiff_t neighbour;  ///< from pixel to pixel across the line

  /// Twice the gradient along the row or column, k pixels from the line; |k| <= kRadius.
  int twiceGradient(int k) const { return grey[(k + 1) * neighbour] - grey[(k - 1) * neighbour]; }
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
        scale_(0.5 / across_.minor),
        size_(axis.minor == 0 ? image.cols : image.rows),
        stations_(axis.minor == 0 ? image.rows : image.cols),
        image_step_(axis, image),
        ground_step_(axis, ground) {}

  const Axis& axis() const { return axis_; }
  /// From twice the gradient along a row or column to that across the line, grey/px, positive when brighter
  /// `across`.
  double scale() const { return scale_; }

  /// Nothing outside image and ground.
  std::optional<Station> at(int station) const {
    const int centre = cvRound(origin_.minor + along_.minor * ((station - origin_.major) / along_.major));
    constexpr int kReach = kRadius + 1;
    if (centre < kReach || centre >= size_ - kReach || station < 0 || station >= stations_ ||
        ground_[ground_step_.to(station, centre)] == 0)
      return std::nullopt;
    return Station{station, centre, image_ + image_step_.to(station, centre), image_step_.minor};
  }
  /// Of an edge this far from the station's pixel.
  Peak peak(const Station& station, double distance, double gradient) const {
    const double major = station.number - origin_.major;
    const double minor = station.centre + distance - origin_.minor;
    return {along_.dot(major, minor), across_.dot(major, minor), gradient};
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
  double scale_;
  int size_, stations_;  // of the image, across and along
  Steps image_step_, ground_step_;
};

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// The strongest gradient within `reach` px of the line, interpolated by a parabola.
std::optional<Peak> findPeak(const EdgeSampler& sampler, int station, const EdgeKind& kind, int reach) {
  const std::optional<Station> sample = sampler.at(station);
  if (!sample) return std::nullopt;
  const double scale = kind.sign * sampler.scale();
  const int sign = scale >= 0 ? 1 : -1;
  int best = 0, strongest = std::numeric_limits<int>::min();
  for (int k = -reach - 1; k <= reach + 1; ++k) {
    const int gradient = sign * sample->twiceGradient(k);
    best = gradient > strongest ? k : best;
    strongest = std::max(strongest, gradient);
  }
  const auto g = [&](int k) { return scale * sample->twiceGradient(k); };
  if (std::abs(best) > reach || g(best) < kind.min_gradient) return std::nullopt;
  const double before = g(best - 1), after = g(best + 1);
  return sampler.peak(*sample, best + 0.5 * (before - after) / (before - 2 * g(best) + after), g(best));
}

/// Peaks at the rows or columns between two distances along the line.
void collect(const EdgeSampler& sampler, double from, double to, const EdgeKind& kind, int reach,
             Peaks& peaks) {
  const Axis& axis = sampler.axis();
  const int first = static_cast<int>(std::ceil(axis.point(from)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(to)[axis.major]));
  const int step = std::max(1, (last - first) / kMaxStations);
  peaks.stations = 0;
  peaks.resize(2 * kMaxStations);
  int count = 0;
  for (int station = first; station <= last; station += step) {
    ++peaks.stations;
    if (const auto peak = findPeak(sampler, station, kind, reach)) peaks.set(count++, *peak);
  }
  peaks.resize(count);
}

/// How far the edge goes on beyond `from`, in steps of this many rows or columns.
double grow(const EdgeSampler& sampler, double from, int step, const EdgeKind& kind) {
  const Axis& axis = sampler.axis();
  double end = from;
  int misses = 0;
  for (int station = cvRound(axis.point(from)[axis.major]) + step; misses < kMaxMisses; station += step) {
    const auto peak = findPeak(sampler, station, kind, 1);
    if (peak && std::abs(peak->across) < 1) {
      end = peak->along;
      misses = 0;
    } else {
      ++misses;
    }
  }
  return end;
}

/// Of values >= 0, the upper one of two in the middle. They are shared out among buckets, so that only the
/// few in the middle one are put in order.
double median(const Values& values) {
  constexpr int kBuckets = 32;
  constexpr double kNothing = 1e-30;
  const double largest = values.maxCoeff();
  if (!(largest > kNothing)) return largest;
  const double scale = (kBuckets - 0.5) / largest;
  std::array<int, kBuckets> counts{};
  std::array<uchar, 2 * kMaxStations> bucket_of;
  for (int i = 0; i < values.size(); ++i) {
    bucket_of[i] = static_cast<uchar>(values[i] * scale);
    ++counts[bucket_of[i]];
  }
  int rank = static_cast<int>(values.size() / 2), bucket = 0;
  while (rank >= counts[bucket]) rank -= counts[bucket++];
  std::array<double, 2 * kMaxStations> middle;
  int count = 0;
  for (int i = 0; i < values.size(); ++i) {
    middle[count] = values[i];
    count += bucket_of[i] == bucket ? 1 : 0;
  }
  std::nth_element(middle.begin(), middle.begin() + rank, middle.begin() + count);
  return middle[rank];
}

/// Weighted straight line across = offset + slope (along - centre).
struct Fit {
  double centre = 0, offset = 0, slope = 0, weight = 0, spread = 0;  // spread: sum w (along - centre)^2

  Values residuals(const Peaks& p) const { return p.across - offset - slope * (p.along - centre); }
};

Fit fitOnce(const Peaks& p) {
  Fit f;
  f.weight = p.weight.sum();
  f.centre = (p.weight * p.along).sum() / f.weight;
  f.offset = (p.weight * p.across).sum() / f.weight;
  const Values x = p.along - f.centre, weighted = p.weight * x;
  f.spread = (weighted * x).sum();
  f.slope = (weighted * p.across).sum() / f.spread;
  return f;
}

/// Iteratively reweighted: the peak's variance falls with the gradient squared, and Tukey's biweight
/// removes stations at which something else was taken for the edge.
Fit fitRobustly(Peaks& peaks, double& scale) {
  const Values base = (peaks.gradient / median(peaks.gradient)).square().min(1.0);
  peaks.weight = base;
  Fit fit = fitOnce(peaks);
  for (int i = 0; i < 3; ++i) {
    const Values off = fit.residuals(peaks).abs();
    scale = std::max(1.4826 * median(off), kMinScale);
    const double inverse = 1 / (4.685 * scale);
    peaks.weight = base * (1 - (off * inverse).min(1.0).square()).square();
    fit = fitOnce(peaks);
  }
  return fit;
}

/// Variance of one station's peak, with what neighbouring stations have in common (a ragged edge is ragged
/// over more than one station): weighted scatter times (1 + rho) / (1 - rho), rho their correlation.
double stationVariance(const Peaks& peaks, const Fit& fit) {
  const Values residuals = fit.residuals(peaks);
  double squares = 0, products = 0, pairs = 0;
  int used = 0;
  for (int i = 0; i < peaks.size(); ++i) {
    if (peaks.weight[i] <= 0) continue;
    ++used;
    const double r = residuals[i];
    squares += peaks.weight[i] * r * r;
    if (i == 0 || peaks.weight[i - 1] <= 0) continue;
    const double w = std::sqrt(peaks.weight[i] * peaks.weight[i - 1]);
    products += w * r * residuals[i - 1];
    pairs += w;
  }
  const double variance = squares / fit.weight;
  const double rho = pairs > 0 && variance > 0 ? std::clamp(products / pairs / variance, 0.0, 0.9) : 0;
  return variance * used / std::max(used - 2, 1) * (1 + rho) / (1 - rho);
}

/// Sign of the edge: the one of which more gradient is found along the line.
int edgeSign(const EdgeSampler& sampler, double half) {
  const Axis& axis = sampler.axis();
  double sum = 0;
  const int first = cvRound(axis.point(-half)[axis.major]), last = cvRound(axis.point(half)[axis.major]);
  const int step = std::max(1, (last - first) / 16);
  for (int station = first; station <= last; station += step)
    if (const std::optional<Station> sample = sampler.at(station)) {
      int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
      for (int k = 1 - kRadius; k < kRadius; ++k) {
        lowest = std::min(lowest, sample->twiceGradient(k));
        highest = std::max(highest, sample->twiceGradient(k));
      }
      sum += sampler.scale() * (highest + lowest);
    }
  return sum >= 0 ? 1 : -1;
}

LineSegment finish(const Axis& axis, const Peaks& peaks, const Fit& fit, int sign) {
  int begin = 0, end = peaks.size() - 1;
  while (peaks.weight[begin] <= 0) ++begin;
  while (peaks.weight[end] <= 0) --end;
  const double first = peaks.along[begin], last = peaks.along[end];
  const auto point = [&](double along) -> Eigen::Vector2d {
    return axis.point(along) + (fit.offset + fit.slope * (along - fit.centre)) * axis.across;
  };
  const double variance = stationVariance(peaks, fit);
  const double off_centre = 0.5 * (first + last) - fit.centre;
  const double angle_variance = variance / fit.spread + 12 * std::pow(kOffsetFloor / (last - first), 2);
  const double offset_variance =
      variance / fit.weight + off_centre * off_centre * variance / fit.spread + kOffsetFloor * kOffsetFloor;
  const Eigen::Vector2d a = point(first), b = point(last);
  return sign > 0 ? makeLineSegment(a, b, std::sqrt(offset_variance), std::sqrt(angle_variance))
                  : makeLineSegment(b, a, std::sqrt(offset_variance), std::sqrt(angle_variance));
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
  for (const int reach : {2, 1}) {
    const EdgeSampler sampler(image, ground, axis);
    collect(sampler, from, to, kind, reach, peaks);
    if (peaks.size() < kMinStations) return std::nullopt;
    double scale = 0;
    const Fit fit = fitRobustly(peaks, scale);
    const auto used = (peaks.weight > 0).count();
    if (used < kMinStations || used < kMinSupport * peaks.stations || scale > kMaxScatter)
      return std::nullopt;
    if (reach == 1) return finish(axis, peaks, fit, kind.sign);
    axis = Axis(axis.point(fit.centre) + fit.offset * axis.across, axis.along + fit.slope * axis.across);
    const EdgeSampler refined(image, ground, axis);
    from = grow(refined, from - fit.centre, -kGrowStep, kind);
    to = grow(refined, to - fit.centre, kGrowStep, kind);
  }
  return std::nullopt;
}

}  // namespace uav_landing
