#include "kernels/samples/line_sums.h"

#include <algorithm>
#include <array>
#include <opencv2/core/hal/intrin.hpp>

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

/// Sum of the lanes and of a remainder of fewer than kLanes values, in the order of Eigen's sums.
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

/// Sums over samples. terms: function (i, std::array<Lanes, kSums>&) that gives the terms from sample i on.
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

}  // namespace

UAV_LANDING_MULTIVERSION LineFit fitLine(const LineSamples& samples) {
  const std::array<float, 3> sums = addUp<3>(samples.count, [&](int i, auto& terms) {
    Lanes weight, along, across;
    load(samples.weight + i, weight);
    load(samples.along + i, along);
    load(samples.across + i, across);
    terms = {weight, weight * along, weight * across};
  });
  LineFit f;
  f.weight = sums[0];
  f.centre = sums[1] / f.weight;
  f.offset = sums[2] / f.weight;
  const float centre = f.centre;
  const std::array<float, 2> moments = addUp<2>(samples.count, [&](int i, auto& terms) {
    Lanes weight, along, across;
    load(samples.weight + i, weight);
    load(samples.along + i, along);
    load(samples.across + i, across);
    const Lanes x = along - centre, weighted = weight * x;
    terms = {weighted * x, weighted * across};
  });
  f.spread = moments[0];
  f.slope = moments[1] / f.spread;
  return f;
}

UAV_LANDING_MULTIVERSION float measureDistances(const LineSamples& samples, const LineFit& line,
                                                float* distances) {
  const float centre = line.centre, offset = line.offset, slope = line.slope;
  const std::array<float, 1> sum = addUp<1>(samples.count, [&](int i, auto& terms) {
    Lanes along, across;
    load(samples.along + i, along);
    load(samples.across + i, across);
    const Lanes off = across - offset - slope * (along - centre);
    terms[0] = off < 0 ? -off : off;
    store(terms[0], distances + i);
  });
  return sum[0] / static_cast<float>(samples.count);
}

UAV_LANDING_MULTIVERSION void weighByDistance(const float* base, const float* distances, float inverse,
                                              int count, float* weights) {
  const Lanes one = Lanes{} + 1;
  for (int i = 0; i < count; i += kLanes) {
    Lanes own, distance;
    load(base + i, own);
    load(distances + i, distance);
    const Lanes share = distance * inverse, within = share < one ? share : one;
    const Lanes left = 1 - within * within;
    store(own * (left * left), weights + i);
  }
}

UAV_LANDING_MULTIVERSION void weighByShare(const float* values, float enough, int count, float* weights) {
  const Lanes one = Lanes{} + 1;
  for (int i = 0; i < count; i += kLanes) {
    Lanes value;
    load(values + i, value);
    const Lanes share = value / enough, square = share * share;
    store(square < one ? square : one, weights + i);
  }
}

UAV_LANDING_MULTIVERSION float meanOf(const float* values, int count) {
  const std::array<float, 1> sum = addUp<1>(count, [&](int i, auto& terms) { load(values + i, terms[0]); });
  return sum[0] / static_cast<float>(count);
}

LineScatter scatterAbout(const LineSamples& samples, const LineFit& line) {
  // With values of no weight before the first sample and after the last.
  alignas(sizeof(Lanes)) std::array<float, kMostLineSamples + 2 * kLanes> weight, off;
  for (int i = 0; i < samples.count; ++i)
    off[kLanes + i] = samples.across[i] - line.offset - line.slope * (samples.along[i] - line.centre);
  std::copy_n(samples.weight, samples.count, weight.begin() + kLanes);
  weight[kLanes - 1] = off[kLanes - 1] = 0;
  std::fill_n(weight.begin() + kLanes + samples.count, kLanes, 0.0F);
  std::fill_n(off.begin() + kLanes + samples.count, kLanes, 0.0F);
  LineScatter scatter{0, 0, 0};
  // In the samples' order, so that the sums do not depend on how many are added at once.
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
  for (int i = kLanes; i < kLanes + samples.count; i += cv::v_float32x4::nlanes) {
    const cv::v_float32x4 w = cv::v_load(&weight[i]), here = cv::v_load(&off[i]),
                          before = cv::v_load(&off[i - 1]);
    const cv::v_float32x4 shared = cv::v_sqrt(w * cv::v_load(&weight[i - 1]));
    addAll(cv::v_cvt_f64(w), cv::v_cvt_f64(shared), cv::v_cvt_f64(here), cv::v_cvt_f64(before));
    addAll(cv::v_cvt_f64_high(w), cv::v_cvt_f64_high(shared), cv::v_cvt_f64_high(here),
           cv::v_cvt_f64_high(before));
  }
  return scatter;
}

}  // namespace uav_landing
