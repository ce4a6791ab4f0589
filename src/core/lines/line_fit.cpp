#include "lines/line_fit.h"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>
#include <tuple>

#include "estimation/robust.h"
#include "kernels/lanes/multiversion.h"
#include "kernels/lanes/order_statistic.h"
#include "lines/line_segment.h"

namespace uav_landing::line_fit {

namespace {

constexpr double kOffsetFloor = 0.03;  // px: pixel grid, fixed-point maps, lens model
constexpr double kMinScale = 0.05;     // px, scale of the robust weights
constexpr float kConverged = 0.01F;    // px, a third of the floor

using PaddedPeaks = PaddedValues<2 * kMaxStations>;

/// The sum of lanes and of what is left over, fewer than lanes, in the order of Eigen's sums.
[[gnu::always_inline]] inline float total(const Lanes& lanes, const Lanes& rest, int left) {
  constexpr int kHalf = kLanes / 2;
  std::array<float, kHalf> half;
  for (int k = 0; k < kHalf; ++k) half[k] = lanes[k] + lanes[k + kHalf];
  const bool half_left = left >= kHalf;
  for (int k = 0; half_left && k < kHalf; ++k) half[k] += rest[k];
  float sum = (half[0] + half[2]) + (half[1] + half[3]);
  for (int k = half_left ? kHalf : 0; k < left; ++k) sum += rest[k];
  return sum;
}

/// Sums over the peaks. terms: function (i, std::array<Lanes, kSums>&) of what is added from peak i on.
template <int kSums, class Terms>
[[gnu::always_inline]] inline std::array<float, kSums> addUp(int count, const Terms& terms) {
  std::array<Lanes, kSums> sums{}, term{};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    terms(i, term);
    for (int k = 0; k < kSums; ++k) sums[k] += term[k];
  }
  if (i < count) terms(i, term);
  std::array<float, kSums> totals;
  for (int k = 0; k < kSums; ++k) totals[k] = total(sums[k], term[k], count - i);
  return totals;
}

UAV_LANDING_MULTIVERSION Fit fitOnce(const Peaks& p) {
  const std::array<float, 3> sums = addUp<3>(p.count, [&](int i, auto& terms) {
    Lanes weight, along, across;
    load(&p.weight[i], weight);
    load(&p.along[i], along);
    load(&p.across[i], across);
    terms = {weight, weight * along, weight * across};
  });
  Fit f;
  f.weight = sums[0];
  f.centre = sums[1] / f.weight;
  f.offset = sums[2] / f.weight;
  const float centre = f.centre;
  const std::array<float, 2> moments = addUp<2>(p.count, [&](int i, auto& terms) {
    Lanes weight, along, across;
    load(&p.weight[i], weight);
    load(&p.along[i], along);
    load(&p.across[i], across);
    const Lanes x = along - centre, weighted = weight * x;
    terms = {weighted * x, weighted * across};
  });
  f.spread = moments[0];
  f.slope = moments[1] / f.spread;
  return f;
}

/// How far the peaks are off a line; returns their mean.
UAV_LANDING_MULTIVERSION float measureDistances(const Peaks& p, const Fit& line, Values& distances) {
  const float centre = line.centre, offset = line.offset, slope = line.slope;
  const std::array<float, 1> sum = addUp<1>(p.count, [&](int i, auto& terms) {
    Lanes along, across;
    load(&p.along[i], along);
    load(&p.across[i], across);
    const Lanes off = across - offset - slope * (along - centre);
    terms[0] = off < 0 ? -off : off;
    store(terms[0], &distances[i]);
  });
  return sum[0] / static_cast<float>(p.count);
}

/// Tukey's, of distances over the one where there is none left, times a weight that a peak has anyway.
UAV_LANDING_MULTIVERSION void weigh(const Values& base, const Values& distances, float inverse, int count,
                                    Values& weights) {
  const Lanes one = Lanes{} + 1;
  for (int i = 0; i < count; i += kLanes) {
    Lanes own, distance;
    load(&base[i], own);
    load(&distances[i], distance);
    const Lanes share = distance * inverse, within = share < one ? share : one;
    const Lanes left = 1 - within * within;
    store(own * (left * left), &weights[i]);
  }
}

/// Of values >= 0 with this mean, the upper one of two in the middle.
float median(PaddedPeaks& values, float mean) {
  constexpr float kNothing = 1e-30F;
  if (!(mean > kNothing)) return mean;
  values.pad();
  constexpr float kUsual = 0.8F;  // of the mean: the median of the magnitudes of normal errors
  return orderStatistic(values, values.count / 2, kUsual * mean);
}

UAV_LANDING_MULTIVERSION float meanGradient(const Peaks& p) {
  const std::array<float, 1> sum =
      addUp<1>(p.count, [&](int i, auto& terms) { load(&p.gradient[i], terms[0]); });
  return sum[0] / static_cast<float>(p.count);
}

/// By gradients over the one from which on they do not matter.
UAV_LANDING_MULTIVERSION void weighByGradient(const Peaks& p, float enough, Values& weights) {
  const Lanes one = Lanes{} + 1;
  for (int i = 0; i < p.count; i += kLanes) {
    Lanes gradient;
    load(&p.gradient[i], gradient);
    const Lanes share = gradient / enough, square = share * share;
    store(square < one ? square : one, &weights[i]);
  }
}

/// Between two lines, at the first and the last peak.
float largestDistance(const Fit& a, const Fit& b, const Peaks& p) {
  const auto at = [&](float along) {
    return std::abs(b.offset - a.offset + b.slope * (along - b.centre) - a.slope * (along - a.centre));
  };
  return std::max(at(p.along[0]), at(p.along[p.count - 1]));
}

void weighByGradient(Peaks& peaks, Values& weights) {
  peaks.pad();
  PaddedPeaks gradients;
  gradients.count = peaks.count;
  std::copy_n(peaks.gradient.begin(), peaks.count, gradients.values.begin());
  weighByGradient(peaks, median(gradients, meanGradient(peaks)), weights);
}

/// Fit with weights by how far the peaks are off a line.
Fit reweighted(Peaks& peaks, const Values& base, const Fit& line, double& scale) {
  PaddedPeaks off;
  off.count = peaks.count;
  const float mean = measureDistances(peaks, line, off.values);
  scale = std::max(kPerMedian * median(off, mean), kMinScale);
  weigh(base, off.values, static_cast<float>(1 / (TukeyEnd::kEfficient * scale)), peaks.count, peaks.weight);
  return fitOnce(peaks);
}

/// The weighted scatter of peaks about a line, and what neighbours have in common.
struct Scatter {
  double squares;          ///< of the distances
  double products, pairs;  ///< of neighbours' distances, and their weights
};

Scatter scatterOf(const Peaks& p, const Fit& line) {
  // With something of no weight before the first peak and after the last.
  alignas(sizeof(Lanes)) std::array<float, std::tuple_size<Values>::value + 2 * kLanes> weight, off;
  for (int i = 0; i < p.count; ++i)
    off[kLanes + i] = p.across[i] - line.offset - line.slope * (p.along[i] - line.centre);
  std::copy_n(p.weight.begin(), p.count, weight.begin() + kLanes);
  weight[kLanes - 1] = off[kLanes - 1] = 0;
  std::fill_n(weight.begin() + kLanes + p.count, kLanes, 0.0F);
  std::fill_n(off.begin() + kLanes + p.count, kLanes, 0.0F);
  Scatter scatter{0, 0, 0};
  // In the peaks' order, so that the sums do not depend on how many are worked on at once.
  const auto add = [](const cv::v_float64x2& terms, double& sum) {
    alignas(sizeof(terms)) std::array<double, cv::v_float64x2::nlanes> term;
    cv::v_store_aligned(term.data(), terms);
    for (const double t : term) sum += t;
  };
  const auto addAll = [&](const cv::v_float64x2& w, const cv::v_float64x2& shared,
                          const cv::v_float64x2& here, const cv::v_float64x2& before) {
    add(w * here * here, scatter.squares);
    add(shared * here * before, scatter.products);
    add(shared, scatter.pairs);
  };
  for (int i = kLanes; i < kLanes + p.count; i += cv::v_float32x4::nlanes) {
    const cv::v_float32x4 w = cv::v_load(&weight[i]), here = cv::v_load(&off[i]),
                          before = cv::v_load(&off[i - 1]);
    const cv::v_float32x4 shared = cv::v_sqrt(w * cv::v_load(&weight[i - 1]));
    addAll(cv::v_cvt_f64(w), cv::v_cvt_f64(shared), cv::v_cvt_f64(here), cv::v_cvt_f64(before));
    addAll(cv::v_cvt_f64_high(w), cv::v_cvt_f64_high(shared), cv::v_cvt_f64_high(here),
           cv::v_cvt_f64_high(before));
  }
  return scatter;
}

/// Variance of one station's peak, with what neighbouring stations have in common (a ragged edge is ragged
/// over more than one station): weighted scatter times (1 + rho) / (1 - rho), rho their correlation.
double stationVariance(const Peaks& peaks, const Fit& fit) {
  const Scatter scatter = scatterOf(peaks, fit);
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
