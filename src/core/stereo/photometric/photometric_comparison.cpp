// The comparison of PhotometricBlocks with the right image; how they are chosen is in photometric_blocks.cpp.

#include <algorithm>
#include <optional>

#include "estimation/robust.h"
#include "stereo/photometric/photometric_blocks.h"

namespace uav_landing {
namespace {

constexpr int kWidth = PhotometricBlocks::kWidth, kHeight = PhotometricBlocks::kHeight;
constexpr int kPixels = PhotometricBlocks::kPixels, kMargin = PhotometricBlocks::kMargin;
// Variance of a derivative by Sobel's kernel over that of the noise.
constexpr double kSlopeNoise = 0.1875;
// Variance of the noise in the right image after interpolation over that before (0.64 of it is left half-way
// between two pixels).
constexpr double kInterpolated = 0.76;
// The variance that a block of nothing but noise may show, over the lower quartile: three sigma of
// chi-square.
constexpr double kNoiseScatter = 1.45;
// Squared correlation, noise taken off, below which a block does not show what the other image has there.
constexpr double kLeastCorrelation = 0.75;
// Share of a block's grey levels that must be more than noise.
constexpr double kLeastShareOfGrey = 0.25;
// Least gain of the right image over the left one.
constexpr double kLeastGain = 0.2;
// Variance of rounding to whole grey levels in two images.
constexpr double kLeastVariance = 1.0 / 6.0;

// The lower quartile of the variances that blocks of noise show, over their mean (chi-square).
constexpr double kQuartile = 0.915;
// Sum of the products of Sobel's kernel, as a derivative, and the one of fourth order; variance per pixel of
// the products of what they make of noise with a variance of 1, summed over a block.
constexpr double kProductNoise = 1.0 / 3, kProductScatter = 0.505;
// Of the usual signal over the noise: less cannot be told from none.
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
    // Blocks have their own gains while the common one is not known. That of a block of nothing but noise is
    // about none, so its residuals lack the left image's noise: alone they would make the noise half as large
    // as it is.
    std::transform(products_.begin(), products_.end(), variances.begin(), [&](const Products& products) {
      return round == 0 ? products.variance : products.varianceAt(found.gain);
    });
    // Blocks that are not on the plane leave large residuals, so those of the best fitting ones tell the
    // noise.
    found.residual = lowerQuartileOf(variances);
    found.noise = found.residual / kQuartile / (found.gain * found.gain + kInterpolated);
    // The noise of the left image makes its squares larger than what both images have in common.
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
  // The derivative less what of it looks like a gain: slope - mixed grey.
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
  // What the right image has beside noise: the part that is like the block, and the rest.
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
