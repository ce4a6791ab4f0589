#include "stereo/band_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "stereo/texture_bands.h"
#include "support/consistency.h"
#include "support/random_texture.h"

namespace uav_landing {
namespace {

constexpr int kColumns = 12, kLines = 16;

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
  double line = 0;  // contrast of one that runs down the middle
  unsigned texture = 1;

  cv::Mat shown(uint64_t seed) const {
    const test::RandomTexture random(texture);
    cv::Mat image(kLines * kBlockHeight + 2 * kGridRow, kColumns * kBlockWidth + 2 * kGridColumn, CV_32F);
    const double middle = image.cols / 2.0;
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double x = u + shift;
        const double light = contrast * random.at(x / grain, v / grain) +
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
    TextureBands of_left, of_right;
    of_left.split(left.shown(2 * seed));
    of_right.split(right.shown(2 * seed + 1));
    std::vector<BandSums> sums, around;
    for (int band = TextureBands::kBands - 1; band >= 0; --band) {
      addUp(of_left[band], of_right[band], TextureBands::factor(band), grid, sums);
      if (gain == 0) gain = gainOf(sums).value_or(0);
      addNeighbours(grid, sums, around);
      addEvidence(grid, sums, around, gain, noiseOf(grid, around, gain), TextureBands::signalNoise(band),
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

/// Texture of half the contrast that the noise has.
TEST(BandEvidence, ClaimsOfFaintTextureWhatItIsWrongBy) {
  constexpr int kPairs = 60;
  double normalised = 0, mean = 0;
  for (int i = 0; i < kPairs; ++i) {
    Picture left, right;
    left.texture = right.texture = i + 1;
    left.contrast = right.contrast = 4;
    left.noise = right.noise = 8;
    right.shift = 0.3;
    const Compared compared(left, right, i + 1);
    const double error = compared.all.shift() - 0.3;
    normalised += std::pow(error / compared.all.stddev(), 2) / kPairs;
    mean += error / kPairs;
  }
  EXPECT_LT(normalised, 1 + test::chiSquareMeanTolerance(kPairs, 1));
  EXPECT_GT(normalised, 1 - test::chiSquareMeanTolerance(kPairs, 1));
  EXPECT_LT(std::abs(mean), 0.02) << "of 0.3 px: all of the shift shows";
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
  Picture left, right;
  left.contrast = right.contrast = 0;
  left.noise = right.noise = 5;
  Compared noise(left, right, 4);
  left.contrast = right.contrast = 5;
  const Compared texture(left, right, 4);
  EXPECT_FALSE(noise.gain > 0.5 && noise.all.stddev() < 5 * texture.all.stddev());
}

TEST(BandEvidence, SeesThatTheRightImageShowsSomethingElse) {
  Picture left, right;
  left.noise = right.noise = 1;
  right.texture = 2;
  const Compared compared(left, right, 5, 1);
  EXPECT_FALSE(compared.all.looksAlike());
}

/// The constants of TextureBands::signalNoise().
TEST(BandEvidence, KnowsByHowMuchNoiseLooksLikeASignal) {
  Picture noise;
  noise.contrast = 0;
  noise.noise = 1;
  for (int band = 0; band < TextureBands::kBands; ++band) {
    double squares = 0, expected = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
      TextureBands left, right;
      left.split(noise.shown(2 * seed));
      right.split(noise.shown(2 * seed + 1));
      std::vector<BandSums> sums;
      addUp(left[band], right[band], TextureBands::factor(band), everywhere(), sums);
      for (const BandSums& block : sums) {
        squares += block.signal * block.signal;
        expected += TextureBands::signalNoise(band) * block.slopes * block.right / block.count;
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
