#include "line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

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

/// Where the edge is at one station: distances along and across the current line, px.
struct Peak {
  double along, across, gradient, weight;
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
  /// Distance along at a row (of a steep line) or column (of a flat one).
  double alongAt(int station) const { return (station - origin[major]) / along[major]; }
};

/// Gradient at -kRadius to kRadius px from the line along the row or column of a station, as the gradient
/// across the line, grey/px, positive when brighter `across`.
using Gradients = std::array<double, 2 * kRadius + 1>;

/// Looks at whole pixels only: interpolating between them biases the peak by up to 0.1 px.
class EdgeSampler {
 public:
  EdgeSampler(const cv::Mat& image, const cv::Mat& ground) : image_(image), ground_(ground) {}

  /// Gradients and the pixel in their middle; nothing outside image and ground.
  std::optional<std::pair<Gradients, cv::Point>> at(const Axis& axis, int station) const {
    const int centre = cvRound(axis.point(axis.alongAt(station))[axis.minor]);
    const cv::Point pixel = axis.major == 1 ? cv::Point(centre, station) : cv::Point(station, centre);
    constexpr int kReach = kRadius + 1;
    const int size = axis.minor == 0 ? image_.cols : image_.rows;
    if (centre < kReach || centre >= size - kReach || pixel.x < 0 || pixel.y < 0 || pixel.x >= image_.cols ||
        pixel.y >= image_.rows || ground_.at<uchar>(pixel) == 0)
      return std::nullopt;
    const uchar* middle = image_.ptr<uchar>(pixel.y) + pixel.x;
    const std::ptrdiff_t step = axis.minor == 0 ? 1 : static_cast<std::ptrdiff_t>(image_.step);
    const double scale = 0.5 / axis.across[axis.minor];
    Gradients gradients;
    for (int k = -kRadius; k <= kRadius; ++k)
      gradients[kRadius + k] = scale * (middle[(k + 1) * step] - middle[(k - 1) * step]);
    return std::make_pair(gradients, pixel);
  }

 private:
  const cv::Mat &image_, &ground_;
};

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// The strongest gradient within `reach` px of the line, interpolated by a parabola.
std::optional<Peak> findPeak(const EdgeSampler& sampler, const Axis& axis, int station, const EdgeKind& kind,
                             int reach) {
  const auto sample = sampler.at(axis, station);
  if (!sample) return std::nullopt;
  const auto g = [&](int k) { return kind.sign * sample->first[kRadius + k]; };
  int best = -reach - 1;
  for (int k = -reach; k <= reach + 1; ++k)
    if (g(k) > g(best)) best = k;
  if (std::abs(best) > reach || g(best) < kind.min_gradient) return std::nullopt;
  Eigen::Vector2d p(sample->second.x, sample->second.y);
  p[axis.minor] += best + 0.5 * (g(best - 1) - g(best + 1)) / (g(best - 1) - 2 * g(best) + g(best + 1));
  p -= axis.origin;
  return Peak{axis.along.dot(p), axis.across.dot(p), g(best), 1};
}

struct Collected {
  std::vector<Peak> peaks;
  int stations = 0;
};

/// Peaks at the rows or columns between two distances along the line.
Collected collect(const EdgeSampler& sampler, const Axis& axis, double from, double to, const EdgeKind& kind,
                  int reach) {
  Collected found;
  const int first = static_cast<int>(std::ceil(axis.point(from)[axis.major]));
  const int last = static_cast<int>(std::floor(axis.point(to)[axis.major]));
  const int step = std::max(1, (last - first) / kMaxStations);
  for (int station = first; station <= last; station += step) {
    ++found.stations;
    if (const auto peak = findPeak(sampler, axis, station, kind, reach)) found.peaks.push_back(*peak);
  }
  return found;
}

/// How far the edge goes on beyond `from`, in steps of this many rows or columns.
double grow(const EdgeSampler& sampler, const Axis& axis, double from, int step, const EdgeKind& kind) {
  double end = from;
  int misses = 0;
  for (int station = cvRound(axis.point(from)[axis.major]) + step; misses < kMaxMisses; station += step) {
    const auto peak = findPeak(sampler, axis, station, kind, 1);
    if (peak && std::abs(peak->across) < 1) {
      end = peak->along;
      misses = 0;
    } else {
      ++misses;
    }
  }
  return end;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Weighted straight line across = offset + slope (along - centre).
struct Fit {
  double centre = 0, offset = 0, slope = 0, weight = 0, spread = 0;  // spread: sum w (along - centre)^2

  double residual(const Peak& p) const { return p.across - offset - slope * (p.along - centre); }
};

Fit fitOnce(const std::vector<Peak>& peaks) {
  Fit f;
  for (const Peak& p : peaks) {
    f.weight += p.weight;
    f.centre += p.weight * p.along;
    f.offset += p.weight * p.across;
  }
  f.centre /= f.weight;
  f.offset /= f.weight;
  double mixed = 0;
  for (const Peak& p : peaks) {
    const double x = p.along - f.centre;
    f.spread += p.weight * x * x;
    mixed += p.weight * x * p.across;
  }
  f.slope = mixed / f.spread;
  return f;
}

/// Iteratively reweighted: the peak's variance falls with the gradient squared, and Tukey's biweight
/// removes stations at which something else was taken for the edge.
Fit fitRobustly(std::vector<Peak>& peaks, double& scale) {
  std::vector<double> values(peaks.size());
  std::transform(peaks.begin(), peaks.end(), values.begin(), [](const Peak& p) { return p.gradient; });
  const double typical = median(values);
  const auto base = [typical](const Peak& p) { return std::min(1.0, std::pow(p.gradient / typical, 2)); };
  for (Peak& p : peaks) p.weight = base(p);
  Fit fit = fitOnce(peaks);
  for (int i = 0; i < 3; ++i) {
    std::transform(peaks.begin(), peaks.end(), values.begin(),
                   [&](const Peak& p) { return std::abs(fit.residual(p)); });
    scale = std::max(1.4826 * median(values), kMinScale);
    for (Peak& p : peaks) {
      const double u = fit.residual(p) / (4.685 * scale);
      p.weight = std::abs(u) < 1 ? base(p) * std::pow(1 - u * u, 2) : 0;
    }
    fit = fitOnce(peaks);
  }
  return fit;
}

/// Variance of one station's peak, with what neighbouring stations have in common (a ragged edge is ragged
/// over more than one station): weighted scatter times (1 + rho) / (1 - rho), rho their correlation.
double stationVariance(const std::vector<Peak>& peaks, const Fit& fit) {
  double squares = 0, products = 0, pairs = 0;
  int used = 0;
  for (size_t i = 0; i < peaks.size(); ++i) {
    if (peaks[i].weight <= 0) continue;
    ++used;
    const double r = fit.residual(peaks[i]);
    squares += peaks[i].weight * r * r;
    if (i == 0 || peaks[i - 1].weight <= 0) continue;
    const double w = std::sqrt(peaks[i].weight * peaks[i - 1].weight);
    products += w * r * fit.residual(peaks[i - 1]);
    pairs += w;
  }
  const double variance = squares / fit.weight;
  const double rho = pairs > 0 && variance > 0 ? std::clamp(products / pairs / variance, 0.0, 0.9) : 0;
  return variance * used / std::max(used - 2, 1) * (1 + rho) / (1 - rho);
}

/// Sign of the edge: the one of which more gradient is found along the line.
int edgeSign(const EdgeSampler& sampler, const Axis& axis, double half) {
  double sum = 0;
  const int first = cvRound(axis.point(-half)[axis.major]), last = cvRound(axis.point(half)[axis.major]);
  const int step = std::max(1, (last - first) / 16);
  for (int station = first; station <= last; station += step)
    if (const auto sample = sampler.at(axis, station)) {
      const auto [lowest, highest] = std::minmax_element(sample->first.begin() + 1, sample->first.end() - 1);
      sum += *highest + *lowest;
    }
  return sum >= 0 ? 1 : -1;
}

LineSegment finish(const Axis& axis, const std::vector<Peak>& peaks, const Fit& fit, int sign) {
  const auto used = [](const Peak& p) { return p.weight > 0; };
  const double first = std::find_if(peaks.begin(), peaks.end(), used)->along;
  const double last = std::find_if(peaks.rbegin(), peaks.rend(), used)->along;
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
  return edgeSign(EdgeSampler(image, ground), axis, 0.5 * (b - a).norm()) * axis.across;
}

std::optional<LineSegment> refineLine(const cv::Mat& image, const cv::Mat& ground, const RoughSegment& rough,
                                      double min_gradient) {
  const EdgeSampler sampler(image, ground);
  Axis axis(0.5 * (rough.a + rough.b), rough.b - rough.a);
  double from = -0.5 * (rough.b - rough.a).norm(), to = -from;
  const EdgeKind kind{axis.across.dot(rough.brighter) >= 0 ? 1 : -1, min_gradient};
  for (const int reach : {2, 1}) {
    Collected found = collect(sampler, axis, from, to, kind, reach);
    std::vector<Peak>& peaks = found.peaks;
    if (static_cast<int>(peaks.size()) < kMinStations) return std::nullopt;
    double scale = 0;
    const Fit fit = fitRobustly(peaks, scale);
    const auto used = std::count_if(peaks.begin(), peaks.end(), [](const Peak& p) { return p.weight > 0; });
    if (used < kMinStations || used < kMinSupport * found.stations || scale > kMaxScatter)
      return std::nullopt;
    if (reach == 1) return finish(axis, peaks, fit, kind.sign);
    axis = Axis(axis.point(fit.centre) + fit.offset * axis.across, axis.along + fit.slope * axis.across);
    from = grow(sampler, axis, from - fit.centre, -kGrowStep, kind);
    to = grow(sampler, axis, to - fit.centre, kGrowStep, kind);
  }
  return std::nullopt;
}

}  // namespace uav_landing
