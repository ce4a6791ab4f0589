#include "stereo/bands/band_evidence.h"

#include <algorithm>
#include <cmath>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

// Median of the square of a normal number.
constexpr double kMedianSquare = 0.4549;
// Variance in the coarsest band from rounding to whole grey levels in two images.
constexpr double kLeastNoise = 0.001;
// Squared correlation without noise. A block below it does not show what the other image has there.
constexpr double kLeastCorrelation = 0.75;

double scoreOf(const BandSums& sums, double gain) { return sums.slope_right - gain * sums.slope_left; }

/// Variance of the difference between the right image's pixels and the left one's.
double residualOf(const BandSums& sums, double gain) {
  const double energy = sums.right - 2 * gain * sums.products + gain * gain * sums.left;
  return std::max(energy / sums.count, kLeastNoise);
}

/// The signal of a block, and the noise of its score.
struct BlockSignal {
  double response = 0;  // change of the right image by a shift of a pixel, times the slopes
  double variance = 0;  // of the score
  double chance = 0;    // excess of response times measured signal over response times true signal
};

BlockSignal signalOf(const ComparedBand& band, size_t block) {
  const BandSums &own = band.sums[block], &around = band.around[block];
  const double gain = band.gain;
  const double share = own.count / around.count, usual = share * around.signal;
  const double residual = std::max(residualOf(around, gain), band.noise.residual);
  // Variance of a signal, with half of the noise in each image.
  const double scatter = band.white.signal * share * around.slopes * residual / (1 + gain * gain);
  const double off = own.signal - usual, square = off * off / scatter;
  const double kept = square > 1 ? 1 - 1 / square : 0;
  const double slopes = share * around.slopes + kept * (own.slopes - share * around.slopes);
  BlockSignal signal;
  signal.response = std::max(0.0, usual + kept * off);
  signal.variance = band.noise.colour * slopes * residual;
  // The excess follows from the derivative of the estimator (Stein 1981).
  signal.chance = scatter * (share + (square > 1 ? (1 - share) * (1 + 1 / square) : 0));
  return signal;
}

/// Share of the responses that is real. Weights and responses share some chance, which makes the sums too
/// large.
double trueShare(const BlockGrid& grid, const ComparedBand& band) {
  double there = 0, all = 0;
  for (size_t i = 0; i < band.sums.size(); ++i) {
    if (!grid.seen[i]) continue;
    const BlockSignal signal = signalOf(band, i);
    if (!(signal.response > 0 && signal.variance > 0)) continue;
    there += (signal.response * band.sums[i].signal - signal.chance) / signal.variance;
    all += signal.response * signal.response / signal.variance;
  }
  return all > 0 ? std::clamp(there / all, 0.0, 1.0) : 0;
}

}  // namespace

void BandEvidence::add(const BandEvidence& more) {
  information += more.information;
  shift_by_information += more.shift_by_information;
  lean_by_information += more.lean_by_information;
  alike += more.alike;
  other += more.other;
}

bool BandEvidence::looksAlike() const { return alike >= kLeastCorrelation * (alike + other); }

std::optional<double> gainOf(const std::vector<BandSums>& sums) {
  constexpr double kLeastGain = 0.2;
  BandSums all;
  for (const BandSums& block : sums) all.add(block);
  const double more = all.right - all.left, common = all.products;
  if (!(common > 0)) return std::nullopt;
  const double gain = (more + std::hypot(more, 2 * common)) / (2 * common);
  return gain > kLeastGain ? std::optional<double>(gain) : std::nullopt;
}

BandNoise noiseOf(const BlockGrid& grid, const std::vector<BandSums>& around, double gain) {
  std::vector<double> residuals, ratios;
  // Where the image is clipped there is no noise.
  const auto counts = [&](size_t i) { return grid.seen[i] && around[i].slopes > 0; };
  for (size_t i = 0; i < around.size(); ++i)
    if (counts(i)) residuals.push_back(residualOf(around[i], gain));
  BandNoise noise;
  if (residuals.empty()) return noise;
  noise.residual = orderStatistic(residuals.data(), residuals.size(), residuals.size() / 4);
  for (size_t i = 0; i < around.size(); ++i) {
    if (!counts(i)) continue;
    const double score = scoreOf(around[i], gain);
    ratios.push_back(score * score /
                     (around[i].slopes * std::max(residualOf(around[i], gain), noise.residual)));
  }
  noise.colour = medianOf(ratios) / kMedianSquare;
  return noise;
}

void addEvidence(const BlockGrid& grid, const ComparedBand& band, std::vector<BandScore>& scores,
                 std::vector<BandEvidence>& evidence) {
  const auto& [sums, around, gain, noise, white] = band;
  const double share = trueShare(grid, band);
  scores.resize(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) {
    const BandScore coarser = scores[i];
    scores[i] = {};
    if (!grid.seen[i] || !(noise.residual > 0)) continue;
    BandEvidence& block = evidence[i];
    block.alike += std::max(0.0, gain * around[i].products / around[i].count) / noise.residual;
    block.other += std::max(0.0, residualOf(around[i], gain) / noise.residual - white.most);
    const BlockSignal signal = signalOf(band, i);
    if (!(share > 0 && signal.response > 0 && signal.variance > 0)) continue;
    scores[i] = {scoreOf(sums[i], gain), share * signal.response, gain * sums[i].down,
                 std::sqrt(signal.variance)};
    const double common = coarser.stddev > 0 ? white.alike_coarser * scores[i].stddev / coarser.stddev : 0;
    const double left = coarser.stddev > 0 ? 1 - white.alike_coarser * white.alike_coarser : 1;
    const double response = scores[i].response - common * coarser.response;
    if (!(response > 0)) continue;
    const double weight = response / (left * signal.variance);
    block.information += weight * response;
    block.shift_by_information += weight * (scores[i].score - common * coarser.score);
    block.lean_by_information += weight * (gain * sums[i].down - common * coarser.lean);
  }
}

}  // namespace uav_landing
