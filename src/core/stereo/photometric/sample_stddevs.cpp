#include "stereo/photometric/sample_stddevs.h"

#include <algorithm>
#include <cmath>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

// By how much rectification may have made the noise of neighbouring pixels alike, as a factor on stddevs.
constexpr double kLargestFactor = 2.0;
// No error that samples have in common is larger, pixels.
constexpr double kLargestCommon = 1.5;
// The quietest samples are one of so many, and at least this many where that is less than half.
constexpr size_t kQuietestShare = 10, kQuietest = 20;
// Of the variance by the median of squared normal errors, the standard deviation: this times the variance
// over the root of their number, 1 / (2 x density of chi-square at its median) over that median.
constexpr double kMedianScatter = 2.33;

}  // namespace

double makeStddevsTrue(const StereoRig& rig, const Eigen::Vector3d& g, double least_factor,
                       std::vector<DisparitySample>& samples) {
  std::vector<double> residuals, stddevs, ratios, missing;
  for (std::vector<double>* values : {&residuals, &stddevs, &ratios, &missing})
    values->reserve(samples.size());
  for (const DisparitySample& sample : samples) {
    residuals.push_back(sample.disparity - rig.fb() * g.dot(rig.ray(sample.u, sample.v)));
    stddevs.push_back(sample.stddev);
  }
  const double offset = medianOf(residuals), middle = medianOf(stddevs);
  for (size_t i = 0; i < samples.size(); ++i)
    if (stddevs[i] >= middle) ratios.push_back(std::abs(residuals[i] - offset) / stddevs[i]);
  const double factor = std::clamp(robustStddev(ratios), least_factor, kLargestFactor);
  const size_t count = std::min(std::max(samples.size() / kQuietestShare, kQuietest), samples.size() / 2);
  const double quiet = orderStatistic(stddevs.data(), stddevs.size(), count);
  // The variance without which half of the quietest samples were off by more than normal errors are.
  for (size_t i = 0; i < samples.size(); ++i) {
    if (stddevs[i] >= quiet) continue;
    const double off = kPerMedian * (residuals[i] - offset), noise = factor * stddevs[i];
    missing.push_back(off * off - noise * noise);
  }
  // Of few samples, noise alone makes it scatter: one sigma of that is not taken for an error.
  const double by_chance = kMedianScatter / std::sqrt(count) * std::pow(factor * quiet, 2);
  const double common =
      missing.empty() ? 0 : std::clamp(medianOf(missing) - by_chance, 0.0, kLargestCommon * kLargestCommon);
  for (DisparitySample& sample : samples)
    sample.stddev = std::sqrt(factor * factor * sample.stddev * sample.stddev + common);
  return common;
}

}  // namespace uav_landing
