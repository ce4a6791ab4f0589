#include "stereo/bands/band_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "stereo/bands/texture_bands.h"
#include "support/consistency.h"
#include "support/random_texture.h"

namespace uav_landing {
namespace {

constexpr int kColumns = 12, kLines = 16;
const cv::Size kSize(kColumns* kBlockWidth + 2 * kGridColumn, kLines* kBlockHeight + 2 * kGridRow);

BlockGrid everywhere() {
  BlockGrid grid;
  grid.columns = kColumns;
  grid.lines = kLines;
  grid.seen.assign(static_cast<size_t>(kColumns) * kLines, 1);
  return grid;
}

/// A texture, known between pixels, as a camera shows it.
struct Picture {
  double contrast = 10, grain = 3, shift = 0, gain = 1, noise = 0;  // grey levels, pixels
  double line = 0;   // contrast of one that runs down the middle
  double slant = 0;  // columns for each row that the texture leans by; not 0: it is the same along its lean
  unsigned texture = 1;
  int other_from = 1 << 20;  // column from which it shows something else

  cv::Mat shown(uint64_t seed) const {
    const test::RandomTexture random(texture), other(texture + 1000);
    cv::Mat image(kSize, CV_32F);
    const double middle = image.cols / 2.0;
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double x = u + shift + slant * v, y = slant == 0 ? v : 0;
        const double light = contrast * (u < other_from ? random : other).at(x / grain, y / grain) +
                             line * std::exp(-0.5 * std::pow((x - middle) / 2, 2));
        image.at<float>(v, u) = static_cast<float>(gain * light);
      }
    }
    cv::Mat disturbance(image.size(), CV_32F);
    cv::RNG(seed).fill(disturbance, cv::RNG::NORMAL, 0, noise);
    return image + disturbance;
  }
};

struct Compared {
  BlockGrid grid = everywhere();
  std::vector<BandEvidence> evidence{grid.seen.size()};
  BandEvidence all;
  double gain = 0;

  /// known: a gain; 0: it is found.
  Compared(const Picture& left, const Picture& right, uint64_t seed, double known = 0) : gain(known) {
    TextureBands of_left(kSize), of_right(kSize);
    of_left.split(left.shown(2 * seed));
    of_right.split(right.shown(2 * seed + 1));
    std::vector<BandSums> sums, around;
    std::vector<BandScore> scores;
    for (int band = TextureBands::kBands - 1; band >= 0; --band) {
      addUp(of_left[band], of_right[band], TextureBands::factor(band), grid, sums);
      if (gain == 0) gain = gainOf(sums).value_or(0);
      addNeighbours(grid, sums, around);
      addEvidence(grid, {sums, around, gain, noiseOf(grid, around, gain), TextureBands::noise(band)}, scores,
                  evidence);
    }
    for (const BandEvidence& block : evidence) all.add(block);
  }
};

TEST(BandEvidence, TellsTheShiftAndTheGain) {
  for (const double shift : {-0.1, 0.0, 0.05}) {
    Picture left, right;
    left.grain = right.grain = 5;
    right.shift = shift;
    right.gain = 0.8;
    left.noise = right.noise = 1;
    const Compared compared(left, right, 1);
    EXPECT_NEAR(compared.gain, 0.8, 0.01);
    EXPECT_NEAR(compared.all.shift(), shift, 0.02) << shift;
    EXPECT_LT(compared.all.stddev(), 0.03);
    EXPECT_TRUE(compared.all.looksAlike());
  }
}

/// Edges that lean by half a column for each row: a right image that lies a row higher shows them there.
TEST(BandEvidence, TellsHowRowsThatAreNotLevelMoveSlantedEdges) {
  for (const double slant : {-0.5, 0.3}) {
    Picture left, right;
    left.grain = right.grain = 5;
    left.slant = right.slant = slant;
    left.noise = right.noise = 1;
    const Compared compared(left, right, 1);
    EXPECT_NEAR(compared.all.lean(), slant, 0.05 * std::abs(slant));
  }
}

/// Texture of half the contrast that the noise has.
TEST(BandEvidence, ClaimsOfFaintTextureWhatItIsWrongBy) {
  constexpr int kPairs = 200;
  double normalised = 0, mean = 0;
  for (int i = 0; i < kPairs; ++i) {
    Picture left, right;
    left.texture = right.texture = i + 1;
    left.contrast = right.contrast = 4;
    left.noise = right.noise = 8;
    right.shift = 0.1;
    const Compared compared(left, right, i + 1);
    const double error = compared.all.shift() - 0.1;
    normalised += std::pow(error / compared.all.stddev(), 2) / kPairs;
    mean += error / kPairs;
  }
  EXPECT_LT(normalised, 1 + test::chiSquareMeanTolerance(kPairs, 1));
  EXPECT_GT(normalised, 1 - test::chiSquareMeanTolerance(kPairs, 1));
  EXPECT_LT(std::abs(mean), 0.02) << "of 0.1 px: all of the shift shows";
}

/// The neighbours of a painted line have none of its signal.
TEST(BandEvidence, LeavesALinesSignalToItsBlocks) {
  Picture left, right;
  left.contrast = right.contrast = 2;
  left.line = right.line = 60;
  left.noise = right.noise = 4;
  const Compared compared(left, right, 3);
  double on_line = 0, beside = 0;
  for (int line = 2; line < kLines - 2; ++line) {
    // The line is on the border of two blocks.
    for (const int column : {kColumns / 2 - 1, kColumns / 2})
      on_line += compared.evidence[compared.grid.at(column, line)].information;
    for (const int column : {kColumns / 2 - 2, kColumns / 2 + 1})
      beside += compared.evidence[compared.grid.at(column, line)].information;
  }
  EXPECT_GT(on_line, 20 * beside);
}

TEST(BandEvidence, KnowsHardlyAShiftOfNoise) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    Picture left, right;
    left.noise = right.noise = 5;
    left.contrast = right.contrast = 5;
    const Compared texture(left, right, seed, 1);
    left.contrast = right.contrast = 0;
    const Compared noise(left, right, seed, 1);
    EXPECT_GT(noise.all.stddev(), 5 * texture.all.stddev()) << seed;
  }
}

/// Half of the picture is white: no noise is seen there, and none is thought to be elsewhere for it.
TEST(BandEvidence, TakesClippedPicturesForNoNoise) {
  std::vector<BandSums> around(4);
  BlockGrid grid;
  grid.columns = 4;
  grid.lines = 1;
  grid.seen.assign(4, 1);
  for (BandSums& block : around) block.count = 100;
  for (BandSums* block : {&around[2], &around[3]}) {
    block->left = block->right = 400;
    block->products = 300;
    block->slopes = 50;
    block->slope_right = 10;
  }
  const BandNoise noise = noiseOf(grid, around, 1);
  EXPECT_NEAR(noise.residual, 2, 1e-6) << "(400 - 600 + 400) / 100";
  EXPECT_NEAR(noise.colour, 100 / (50 * 2) / 0.4549, 1e-3);
}

TEST(BandEvidence, SeesWhereTheRightImageShowsSomethingElse) {
  Picture left, right;
  left.noise = right.noise = 2;
  right.other_from = kColumns / 2 * kBlockWidth;
  const Compared compared(left, right, 5, 1);
  for (int line = 0; line < kLines; ++line) {
    EXPECT_TRUE(compared.evidence[compared.grid.at(1, line)].looksAlike()) << line;
    EXPECT_FALSE(compared.evidence[compared.grid.at(kColumns - 2, line)].looksAlike()) << line;
  }
}

/// TextureBands::Noise::alike_coarser.
TEST(BandEvidence, KnowsHowAlikeNoiseIsInTwoBands) {
  Picture noise;
  noise.contrast = 0;
  noise.noise = 1;
  std::array<std::vector<double>, TextureBands::kBands> scores;
  for (uint64_t seed = 1; seed <= 16; ++seed) {
    TextureBands left(kSize), right(kSize);
    left.split(noise.shown(2 * seed));
    right.split(noise.shown(2 * seed + 1));
    for (int band = 0; band < TextureBands::kBands; ++band) {
      std::vector<BandSums> sums;
      addUp(left[band], right[band], TextureBands::factor(band), everywhere(), sums);
      for (const BandSums& block : sums) scores[band].push_back(block.slope_right - block.slope_left);
    }
  }
  for (int band = 0; band + 1 < TextureBands::kBands; ++band) {
    double both = 0, own = 0, coarser = 0;
    for (size_t i = 0; i < scores[band].size(); ++i) {
      both += scores[band][i] * scores[band + 1][i];
      own += scores[band][i] * scores[band][i];
      coarser += scores[band + 1][i] * scores[band + 1][i];
    }
    EXPECT_NEAR(both / std::sqrt(own * coarser), TextureBands::noise(band).alike_coarser, 0.08) << band;
  }
}

/// TextureBands::Noise::most.
TEST(BandEvidence, KnowsHowFarNoiseScatters) {
  Picture noise;
  noise.contrast = 0;
  noise.noise = 4;
  for (int band = 0; band < TextureBands::kBands; ++band) {
    int beyond = 0, all = 0;
    double largest = 0;
    for (uint64_t seed = 1; seed <= 16; ++seed) {
      TextureBands left(kSize), right(kSize);
      left.split(noise.shown(2 * seed));
      right.split(noise.shown(2 * seed + 1));
      std::vector<BandSums> sums, around;
      addUp(left[band], right[band], TextureBands::factor(band), everywhere(), sums);
      addNeighbours(everywhere(), sums, around);
      const double quartile = noiseOf(everywhere(), around, 1).residual;
      for (const BandSums& block : around) {
        const double residual = (block.left + block.right - 2 * block.products) / block.count;
        largest = std::max(largest, residual / quartile);
        beyond += residual > TextureBands::noise(band).most * quartile;
        ++all;
      }
    }
    EXPECT_LT(beyond, 0.01 * all) << band;
    EXPECT_GT(largest, 0.7 * TextureBands::noise(band).most) << band;
  }
}

/// TextureBands::Noise::signal.
TEST(BandEvidence, KnowsByHowMuchNoiseLooksLikeASignal) {
  Picture noise;
  noise.contrast = 0;
  noise.noise = 1;
  for (int band = 0; band < TextureBands::kBands; ++band) {
    double squares = 0, expected = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
      TextureBands left(kSize), right(kSize);
      left.split(noise.shown(2 * seed));
      right.split(noise.shown(2 * seed + 1));
      std::vector<BandSums> sums;
      addUp(left[band], right[band], TextureBands::factor(band), everywhere(), sums);
      for (const BandSums& block : sums) {
        squares += block.signal * block.signal;
        expected += TextureBands::noise(band).signal * block.slopes * block.right / block.count;
      }
    }
    EXPECT_NEAR(squares, expected, 0.15 * expected) << band;
  }
}

TEST(BandEvidence, GivesNoGainWhereNothingIsInCommon) {
  std::vector<BandSums> sums(1);
  sums[0].left = sums[0].right = 100;
  sums[0].products = -1;
  EXPECT_FALSE(gainOf(sums));
  sums[0].products = 50;
  ASSERT_TRUE(gainOf(sums));
  EXPECT_NEAR(*gainOf(sums), 1, 1e-6);
}

}  // namespace
}  // namespace uav_landing
