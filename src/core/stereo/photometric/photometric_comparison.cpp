// The comparison of PhotometricBlocks with the right image; how they are chosen is in photometric_blocks.cpp.

#include <algorithm>
#include <optional>

#include "estimation/robust.h"
#include "stereo/photometric/photometric_blocks.h"

namespace uav_landing {
namespace {

// Variance of a derivative by Sobel's kernel over that of the noise.
constexpr double kSlopeNoise = 0.1875;
// Variance of the right image's noise after interpolation over that before. Half-way between two pixels, 0.64
// of it is left.
constexpr double kInterpolated = 0.76;
// Largest variance of a block of noise over the lower quartile: three sigma of chi-square.
constexpr double kNoiseScatter = 1.45;
// Squared correlation without noise. A block below it does not show what the other image has there.
constexpr double kLeastCorrelation = 0.75;
// Share of a block's grey levels that must exceed noise.
constexpr double kLeastShareOfGrey = 0.25;
// Smallest gain of the right image over the left one.
constexpr double kLeastGain = 0.2;
// Variance from rounding to whole grey levels in two images.
constexpr double kLeastVariance = 1.0 / 6.0;

// Lower quartile of the variances of noise blocks over their mean (chi-square).
constexpr double kQuartile = 0.915;
// kProductNoise: sum of the products of Sobel's kernel, as a derivative, and the one of fourth order.
// kProductScatter: variance per pixel of their products for noise with a variance of 1, summed over a block.
constexpr double kProductNoise = 1.0 / 3, kProductScatter = 0.505;
// Smallest usual signal over the noise; less cannot be told from none.
constexpr double kLeastUsual = 0.05;

double lowerQuartileOf(const std::vector<double>& values) {
  return orderStatistic(values.data(), values.size(), values.size() / 4);
}

}  // namespace

void PhotometricBlocks::multiply(const cv::Mat& right, const ShiftModel& model) {
  products_.clear();
  for (const Block& block : blocks_) {
    const ShiftModel shift = model.around(block.u + kWidth / 2, block.v + kHeight / 2);
    const float step = static_cast<float>(1 - shift.a);
    const double begin = block.u - shift.at(block.u, block.v), end = begin + step * (kWidth - 1);
    const double down = -shift.b * (kHeight - 1);
    if (std::min({begin, end, begin + down, end + down}) < kMargin ||
        std::max({begin, end, begin + down, end + down}) > right.cols - 1 - kMargin) {
      continue;
    }
    const float reference = right.at<uchar>(block.v, static_cast<int>(begin));
    const BlockSums sums =
        addUp(right, block.v, begin, -shift.b, step, reference, block.grey.data(), block.slope.data());
    const double total = sums.r, grey = sums.greys;
    const double explained = total * total / kPixels + grey * grey / block.grey_energy;
    products_.push_back({&block, grey, sums.slopes, (sums.squares - explained) / (kPixels - 2)});
  }
}

double PhotometricBlocks::Products::varianceAt(double gain) const {
  const double energy = block->grey_energy, beside_own = variance * (kPixels - 2);
  return (beside_own + grey * grey / energy - 2 * gain * grey + gain * gain * energy) / (kPixels - 1);
}

std::optional<PhotometricBlocks::Photometry> PhotometricBlocks::photometry() const {
  constexpr int kRounds = 3;
  std::vector<double> variances(products_.size());
  Photometry found{1, 0, 0};
  for (int round = 0; round < kRounds; ++round) {
    // In the first round the common gain is unknown, so each block has its own. A block of noise has a gain
    // of about zero, so its residuals lack the left image's noise. By these alone, the noise would seem half
    // as large as it is.
    std::transform(products_.begin(), products_.end(), variances.begin(), [&](const Products& products) {
      return round == 0 ? products.variance : products.varianceAt(found.gain);
    });
    // Blocks off the plane leave large residuals, so the best fitting blocks tell the noise.
    found.residual = lowerQuartileOf(variances);
    found.noise = found.residual / kQuartile / (found.gain * found.gain + kInterpolated);
    // The noise of the left image makes its squares larger than the part common to both images.
    double in_common = 0, squares = 0;
    for (const Products& products : products_) {
      in_common += products.grey;
      squares += products.block->grey_energy - found.noise * kPixels;
    }
    found.gain = in_common / squares;
    if (!(squares > 0 && found.gain > kLeastGain)) return std::nullopt;
  }
  return found;
}

std::optional<ShiftEvidence> PhotometricBlocks::evidenceOf(const Products& products,
                                                           const Photometry& photometry) const {
  const Block& block = *products.block;
  const double noise = photometry.noise * kPixels, slope_noise = noise * kSlopeNoise;
  const double common = block.grey_energy - noise;
  if (common < kLeastShareOfGrey * block.grey_energy) return std::nullopt;
  // The derivative without its part that looks like a gain: slope - mixed grey.
  const double mixed = block.both / common;
  ShiftEvidence evidence;
  evidence.blocks = 1;
  evidence.score = products.slope - mixed * products.grey;
  evidence.energy = block.slope_energy - 2 * mixed * block.both + mixed * mixed * block.grey_energy;
  if (!(evidence.energy > 0)) return std::nullopt;
  const double explained = evidence.score * evidence.score / evidence.energy;
  evidence.score_variance =
      evidence.energy * std::max(products.variance - explained / kPixels, kLeastVariance);
  evidence.signal = block.along_slope - mixed * block.along_grey - noise * kProductNoise;
  evidence.signal_variance = photometry.noise * noise * kProductScatter;
  evidence.usual = std::max(usual_energy_ - slope_noise, kLeastUsual * slope_noise);
  evidence.moment_u = evidence.energy * block.centre_u;
  evidence.moment_v = evidence.energy * block.centre_v;
  evidence.down = block.down_slope - mixed * block.down_grey;
  return evidence;
}

bool PhotometricBlocks::looksAlike(const Products& products, const Photometry& photometry, double variance) {
  const double energy = products.block->grey_energy, share = 1 - photometry.noise * kPixels / energy;
  // What the right image has besides noise: the part that is like the block, and the rest.
  const double alike = products.grey * products.grey / energy * share;
  const double other = kPixels * std::max(0.0, variance - kNoiseScatter * photometry.residual);
  return alike >= kLeastCorrelation * (alike + other);
}

void PhotometricBlocks::compare(const cv::Mat& right, const ShiftModel& shift, std::vector<Match>& matches) {
  matches.clear();
  multiply(right, shift);
  if (products_.empty()) return;
  const std::optional<Photometry> common_to_all = photometry();
  if (!common_to_all) return;
  ShiftMatching matching(common_to_all->gain, kTogether * kWidth, matches);
  for (const Products& products : products_) {
    const std::optional<ShiftEvidence> evidence = evidenceOf(products, *common_to_all);
    if (!evidence) continue;
    const bool alike = looksAlike(products, *common_to_all, evidence->score_variance / evidence->energy);
    matching.add(*evidence, alike, products.block->u, products.block->v);
  }
  matching.finish();
}

}  // namespace uav_landing
