#include "stereo/photometric/sample_stddevs.h"

#include <algorithm>
#include <cmath>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

// Largest factor on stddevs, as rectification makes the noise of neighbouring pixels alike.
constexpr double kLargestFactor = 2.0;
// Largest error that samples may have in common, pixels.
constexpr double kLargestCommon = 1.5;
// The quietest samples are one in kQuietestShare. They are at least kQuietest, if that is less than half.
constexpr size_t kQuietestShare = 10, kQuietest = 20;
// Standard deviation of a variance that is estimated by the median of squared normal errors. It is this times
// the variance over the root of their number: 1 / (2 x density of chi-square at its median) over that median.
constexpr double kMedianScatter = 2.33;

}  // namespace

double makeStddevsTrue(const StereoRig& rig, const PlaneVector& g, double least_factor,
                       std::vector<DisparitySample>& samples) {
  std::vector<double> residuals, stddevs, ratios, missing;
  for (std::vector<double>* values : {&residuals, &stddevs, &ratios, &missing})
    values->reserve(samples.size());
  for (const DisparitySample& sample : samples) {
    residuals.push_back(sample.disparity - g.disparity(rig, sample.u, sample.v));
    stddevs.push_back(sample.stddev);
  }
  const double offset = medianOf(residuals), middle = medianOf(stddevs);
  for (size_t i = 0; i < samples.size(); ++i)
    if (stddevs[i] >= middle) ratios.push_back(std::abs(residuals[i] - offset) / stddevs[i]);
  const double factor = std::clamp(robustStddev(ratios), least_factor, kLargestFactor);
  const size_t count = std::min(std::max(samples.size() / kQuietestShare, kQuietest), samples.size() / 2);
  const double quiet = orderStatistic(stddevs.data(), stddevs.size(), count);
  // The variance with which half of the quietest samples agree, beyond that of their noise.
  for (size_t i = 0; i < samples.size(); ++i) {
    if (stddevs[i] >= quiet) continue;
    const double off = kPerMedian * (residuals[i] - offset), noise = factor * stddevs[i];
    missing.push_back(off * off - noise * noise);
  }
  // With few samples noise alone makes it scatter, so one sigma of this scatter is not taken for an error.
  const double by_chance = kMedianScatter / std::sqrt(count) * std::pow(factor * quiet, 2);
  const double common =
      missing.empty() ? 0 : std::clamp(medianOf(missing) - by_chance, 0.0, kLargestCommon * kLargestCommon);
  for (DisparitySample& sample : samples)
    sample.stddev = std::sqrt(factor * factor * sample.stddev * sample.stddev + common);
  return common;
}

}  // namespace uav_landing
