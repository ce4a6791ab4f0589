#include "lines/line_fit.h"

#include <algorithm>

#include "base/order_statistic.h"
#include "lines/line_refinement.h"

namespace uav_landing::line_fit {

namespace {

constexpr double kOffsetFloor = 0.03;  // px: pixel grid, fixed-point maps, lens model
constexpr double kMinScale = 0.05;     // px, scale of the robust weights
constexpr float kConverged = 0.01F;    // px, a third of the floor
constexpr double kTukey = 4.685;       // scales: 95 % as good as least squares when the errors are normal

/// Of values >= 0, the upper one of two in the middle.
float median(const Values& values) {
  constexpr float kNothing = 1e-30F;
  const float mean = values.mean();
  if (!(mean > kNothing)) return mean;
  PaddedValues<2 * kMaxStations> padded;
  padded.count = static_cast<int>(values.size());
  std::copy_n(values.data(), padded.count, padded.values.begin());
  padded.pad();
  constexpr float kUsual = 0.8F;  // of the mean: the median of the magnitudes of normal errors
  return orderStatistic(padded, padded.count / 2, kUsual * mean);
}

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

/// Between two lines, at the first and the last peak.
float largestDistance(const Fit& a, const Fit& b, const Peaks& p) {
  const auto at = [&](float along) {
    return std::abs(b.offset - a.offset + b.slope * (along - b.centre) - a.slope * (along - a.centre));
  };
  return std::max(at(p.along[0]), at(p.along[p.size() - 1]));
}

Values weightsByGradient(const Peaks& p) { return (p.gradient / median(p.gradient)).square().min(1.0F); }

/// Fit with weights by how far the peaks are off a line.
Fit reweighted(Peaks& peaks, const Values& base, const Fit& line, double& scale) {
  const Values off = line.residuals(peaks).abs();
  scale = std::max(1.4826 * median(off), kMinScale);
  const float inverse = static_cast<float>(1 / (kTukey * scale));
  peaks.weight = base * (1 - (off * inverse).min(1.0F).square()).square();
  return fitOnce(peaks);
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

}  // namespace

Fit fitRobustly(Peaks& peaks, double& scale) {
  const Values base = weightsByGradient(peaks);
  peaks.weight = base;
  Fit fit = fitOnce(peaks);
  constexpr int kRounds = 3;
  for (int i = 0; i < kRounds; ++i) {
    const Fit before = fit;
    fit = reweighted(peaks, base, before, scale);
    if (largestDistance(before, fit, peaks) < kConverged) break;
  }
  return fit;
}

Fit refit(Peaks& peaks, double& scale) {
  const Values base = weightsByGradient(peaks);
  const Fit fit = reweighted(peaks, base, Fit(), scale);
  return reweighted(peaks, base, fit, scale);
}

LineSegment segmentOf(const Axis& axis, const Peaks& peaks, const Fit& fit, int sign) {
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

}  // namespace uav_landing::line_fit
