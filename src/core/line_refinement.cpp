#include "line_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace uav_landing {

namespace {

constexpr int kRadius = 3;           // px to both sides, first pass
constexpr double kStationStep = 2;   // px between stations; closer ones share pixels
constexpr double kMaxStations = 80;  // of a long line, which then is at the floor anyway
constexpr int kMinStations = 6;
constexpr double kFewStations = 12;
constexpr double kMinSupport = 0.6;    // share of stations that must show the edge
constexpr double kMaxScatter = 0.6;    // px, 1 sigma of the peaks; more is no straight edge
constexpr double kOffsetFloor = 0.03;  // px: pixel grid, fixed-point maps, lens model
constexpr int kMaxMisses = 2;          // stations without edge at which a growing line ends
constexpr double kMinScale = 0.05;     // px, scale of the robust weights

/// Where the edge is at one station: distances along and across the current line, px.
struct Peak {
  double along, across, gradient, weight;
};

/// Frame of a line: origin, direction along and (across) 90 degrees clockwise in the picture.
struct Axis {
  Eigen::Vector2d origin, along, across;

  static Axis through(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d d = (b - a).normalized();
    return {0.5 * (a + b), d, {-d.y(), d.x()}};
  }
};

/// Gradient across the line at -kRadius to kRadius px from it, grey/px, positive when brighter `across`.
using Gradients = std::array<double, 2 * kRadius + 1>;

class EdgeSampler {
 public:
  EdgeSampler(const cv::Mat& image, const cv::Mat& ground) : image_(image), ground_(ground) {}

  /// At one station, the mean of two places 1 px apart; nothing outside image and ground.
  std::optional<Gradients> at(const Axis& axis, double along) const {
    std::array<float, 2 * kRadius + 3> profile{};
    for (const double shift : {-0.5, 0.5})
      if (!addProfile(axis, along + shift, profile)) return std::nullopt;
    Gradients gradients;
    // The central difference spans 2 px, and the profile is the sum of two.
    for (size_t i = 0; i < gradients.size(); ++i) gradients[i] = 0.25 * (profile[i + 2] - profile[i]);
    return gradients;
  }

 private:
  bool addProfile(const Axis& axis, double along, std::array<float, 2 * kRadius + 3>& profile) const {
    constexpr int reach = kRadius + 1;
    const Eigen::Vector2d centre = axis.origin + along * axis.along;
    const Eigen::Vector2d low = centre - reach * axis.across, high = centre + reach * axis.across;
    if (!inside(low) || !inside(high)) return false;
    if (ground_.at<uchar>(static_cast<int>(centre.y() + 0.5), static_cast<int>(centre.x() + 0.5)) == 0)
      return false;
    for (int i = 0; i <= 2 * reach; ++i) profile[i] += bilinear(low + i * axis.across);
    return true;
  }
  bool inside(const Eigen::Vector2d& p) const {
    return p.x() >= 0 && p.y() >= 0 && p.x() < image_.cols - 1 && p.y() < image_.rows - 1;
  }
  float bilinear(const Eigen::Vector2d& p) const {
    const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
    const float fx = static_cast<float>(p.x() - x), fy = static_cast<float>(p.y() - y);
    const uchar* row = image_.ptr<uchar>(y) + x;
    const uchar* below = image_.ptr<uchar>(y + 1) + x;
    const float top = row[0] + fx * (row[1] - row[0]), bottom = below[0] + fx * (below[1] - below[0]);
    return top + fy * (bottom - top);
  }

  const cv::Mat &image_, &ground_;
};

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// The strongest gradient near the line, interpolated by a parabola: anywhere, but biased by up to 0.1 px.
std::optional<Peak> searchPeak(const Gradients& gradients, double along, const EdgeKind& kind) {
  const auto g = [&](int k) { return kind.sign * gradients[kRadius + k]; };
  int best = -kRadius;
  for (int k = -kRadius + 1; k <= kRadius; ++k)
    if (g(k) > g(best)) best = k;
  if (std::abs(best) == kRadius || g(best) < kind.min_gradient) return std::nullopt;
  const double curvature = g(best - 1) - 2 * g(best) + g(best + 1);
  return Peak{along, best + 0.5 * (g(best - 1) - g(best + 1)) / curvature, g(best), 1};
}

/// The centroid of the gradient within 2.5 px of a line that is nearly right: without bias, whatever the
/// blur. What a wide edge loses outside the window is made up for: moving the edge by d moves the centroid
/// by d (1 - W (f(-W) + f(W))), f the gradient's density and W the window's half width.
std::optional<Peak> centrePeak(const Gradients& gradients, double along, const EdgeKind& kind) {
  constexpr int kTaps = kRadius - 1;
  const auto g = [&](int k) { return std::max(kind.sign * gradients[kRadius + k], 0.0); };
  double sum = 0, moment = 0, strongest = 0;
  int best = 0;
  for (int k = -kTaps; k <= kTaps; ++k) {
    sum += g(k);
    moment += k * g(k);
    if (g(k) <= strongest) continue;
    strongest = g(k);
    best = k;
  }
  if (std::abs(best) > 1 || strongest < kind.min_gradient) return std::nullopt;
  const double border = 0.5 * (g(-kTaps - 1) + g(-kTaps) + g(kTaps) + g(kTaps + 1));
  return Peak{along, moment / sum / std::max(1 - (kTaps + 0.5) * border / sum, 0.4), strongest, 1};
}

struct Collected {
  std::vector<Peak> peaks;
  int stations = 0;
};

/// Closer stations on a short line: they share pixels, but it takes several to see that it is straight.
double stationStep(double length) {
  return std::max(std::clamp(length / kFewStations, 1.0, kStationStep), length / kMaxStations);
}

using PeakFinder = std::optional<Peak> (*)(const Gradients&, double, const EdgeKind&);

Collected collect(const EdgeSampler& sampler, const Axis& axis, double from, double to, const EdgeKind& kind,
                  PeakFinder find) {
  Collected found;
  const double step = stationStep(to - from);
  found.peaks.reserve(static_cast<size_t>((to - from) / step) + 2);
  for (double along = from; along <= to; along += step) {
    ++found.stations;
    const auto gradients = sampler.at(axis, along);
    if (!gradients) continue;
    if (const auto peak = find(*gradients, along, kind)) found.peaks.push_back(*peak);
  }
  return found;
}

/// How far the edge goes on beyond `from`, in steps of this sign and size.
double grow(const EdgeSampler& sampler, const Axis& axis, double from, double step, const EdgeKind& kind) {
  double end = from;
  int misses = 0;
  for (double along = from + step; misses < kMaxMisses; along += step) {
    const auto gradients = sampler.at(axis, along);
    const auto peak = gradients ? searchPeak(*gradients, along, kind) : std::nullopt;
    if (peak && std::abs(peak->across) < 1) {
      end = along;
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
  for (int i = 0; i < 4; ++i) {
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
  const double step = std::max(kStationStep, half / 4);
  for (double along = -half; along <= half; along += step)
    if (const auto gradients = sampler.at(axis, along)) {
      const auto [lowest, highest] = std::minmax_element(gradients->begin() + 1, gradients->end() - 1);
      sum += *highest + *lowest;
    }
  return sum >= 0 ? 1 : -1;
}

LineSegment finish(const Axis& axis, const std::vector<Peak>& peaks, const Fit& fit, int sign) {
  const auto used = [](const Peak& p) { return p.weight > 0; };
  const double first = std::find_if(peaks.begin(), peaks.end(), used)->along;
  const double last = std::find_if(peaks.rbegin(), peaks.rend(), used)->along;
  const auto point = [&](double along) -> Eigen::Vector2d {
    return axis.origin + along * axis.along + (fit.offset + fit.slope * (along - fit.centre)) * axis.across;
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
  const Axis axis = Axis::through(a, b);
  return {
      a, b, {axis.across.x(), axis.across.y(), -axis.across.dot(axis.origin)}, offset_stddev, angle_stddev};
}

std::optional<LineSegment> refineLine(const cv::Mat& image, const cv::Mat& ground, const Eigen::Vector2d& a,
                                      const Eigen::Vector2d& b, double min_gradient) {
  const EdgeSampler sampler(image, ground);
  Axis axis = Axis::through(a, b);
  double from = -0.5 * (b - a).norm(), to = -from;
  const EdgeKind kind{edgeSign(sampler, axis, to), min_gradient};
  for (int pass = 0; pass < 2; ++pass) {
    Collected found = collect(sampler, axis, from, to, kind, pass == 0 ? searchPeak : centrePeak);
    std::vector<Peak>& peaks = found.peaks;
    if (static_cast<int>(peaks.size()) < kMinStations) return std::nullopt;
    double scale = 0;
    const Fit fit = fitRobustly(peaks, scale);
    const auto used = std::count_if(peaks.begin(), peaks.end(), [](const Peak& p) { return p.weight > 0; });
    if (used < kMinStations || used < kMinSupport * found.stations || scale > kMaxScatter)
      return std::nullopt;
    if (pass == 1) return finish(axis, peaks, fit, kind.sign);
    axis.origin += fit.centre * axis.along + fit.offset * axis.across;
    axis = Axis::through(axis.origin - (axis.along + fit.slope * axis.across),
                         axis.origin + (axis.along + fit.slope * axis.across));
    from = grow(sampler, axis, from - fit.centre, -kStationStep, kind);
    to = grow(sampler, axis, to - fit.centre, kStationStep, kind);
  }
  return std::nullopt;
}

}  // namespace uav_landing
