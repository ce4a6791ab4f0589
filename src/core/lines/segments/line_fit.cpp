#include "lines/segments/line_fit.h"

#include <algorithm>

#include "estimation/robust.h"
#include "kernels/lanes/order_statistic.h"
#include "lines/segments/line_segment.h"

namespace uav_landing::line_fit {

namespace {

constexpr double kOffsetFloor = 0.03;  // px: pixel grid, fixed-point maps, lens model
constexpr double kMinScale = 0.05;     // px, smallest scale of the robust weights
constexpr float kConverged = 0.01F;    // px, a third of the floor

using PaddedPeaks = PaddedValues<2 * kMaxStations>;

/// Median of values >= 0 with this mean; of an even number the upper one in the middle.
float median(PaddedPeaks& values, float mean) {
  constexpr float kNothing = 1e-30F;
  if (!(mean > kNothing)) return mean;
  values.pad();
  constexpr float kUsual = 0.8F;  // median of the magnitudes of normal errors over their mean
  return orderStatistic(values, values.count / 2, kUsual * mean);
}

/// Largest distance between two lines, at the first and the last peak.
float largestDistance(const Fit& a, const Fit& b, const Peaks& p) {
  const auto at = [&](float along) {
    return std::abs(b.offset - a.offset + b.slope * (along - b.centre) - a.slope * (along - a.centre));
  };
  return std::max(at(p.along[0]), at(p.along[p.count - 1]));
}

/// Weights by gradient; beyond a certain gradient all weigh the same.
void weighByGradient(Peaks& peaks, Values& weights) {
  peaks.pad();
  PaddedPeaks gradients;
  gradients.count = peaks.count;
  std::copy_n(peaks.gradient.begin(), peaks.count, gradients.values.begin());
  const float enough = median(gradients, meanOf(peaks.gradient.data(), peaks.count));
  weighByShare(peaks.gradient.data(), enough, peaks.count, weights.data());
}

/// Fit with weights by the distance of the peaks from a line.
Fit reweighted(Peaks& peaks, const Values& base, const Fit& line, double& scale) {
  PaddedPeaks off;
  off.count = peaks.count;
  const float mean = measureDistances(peaks.samples(), line, off.values.data());
  scale = std::max(kPerMedian * median(off, mean), kMinScale);
  weighByDistance(base.data(), off.values.data(), static_cast<float>(1 / (TukeyEnd::kEfficient * scale)),
                  peaks.count, peaks.weight.data());
  return fitLine(peaks.samples());
}

/// Variance of the peak at one station. A ragged edge is ragged over several stations, so neighbours share
/// errors. The weighted scatter is therefore multiplied by (1 + rho) / (1 - rho), with rho their correlation.
double stationVariance(const Peaks& peaks, const Fit& fit) {
  const LineScatter scatter = scatterAbout(peaks.samples(), fit);
  const int used = peaks.used();
  const double variance = scatter.squares / fit.weight;
  const double rho = scatter.pairs > 0 && variance > 0
                         ? std::clamp(scatter.products / scatter.pairs / variance, 0.0, 0.9)
                         : 0;
  return variance * used / std::max(used - 2, 1) * (1 + rho) / (1 - rho);
}

}  // namespace

Fit fitRobustly(Peaks& peaks, double& scale) {
  alignas(sizeof(Lanes)) Values base;
  weighByGradient(peaks, base);
  std::copy_n(base.begin(), wholeLanes(peaks.count), peaks.weight.begin());
  Fit fit = fitLine(peaks.samples());
  constexpr int kRounds = 3;
  for (int i = 0; i < kRounds; ++i) {
    const Fit before = fit;
    fit = reweighted(peaks, base, before, scale);
    if (largestDistance(before, fit, peaks) < kConverged) break;
  }
  return fit;
}

Fit refit(Peaks& peaks, double& scale) {
  alignas(sizeof(Lanes)) Values base;
  weighByGradient(peaks, base);
  const Fit fit = reweighted(peaks, base, Fit(), scale);
  return reweighted(peaks, base, fit, scale);
}

LineSegment segmentOf(const Axis& axis, const Peaks& peaks, const Fit& fit, int sign) {
  int begin = 0, end = peaks.count - 1;
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
