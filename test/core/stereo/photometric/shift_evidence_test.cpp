#include "stereo/photometric/shift_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace uav_landing {
namespace {

ShiftEvidence measured(double signal, double stddev, double usual) {
  ShiftEvidence evidence;
  evidence.signal = signal;
  evidence.signal_variance = stddev * stddev;
  evidence.usual = usual;
  return evidence;
}

/// The posterior mean, integrated: normal errors, density 1 / (usual + signal)^2 of positive signals.
double meanByIntegration(double signal, double stddev, double usual) {
  double sum = 0, weighted = 0;
  for (double s = 0; s < 20 * (stddev + std::abs(signal)); s += 0.001 * stddev) {
    const double z = (signal - s) / stddev;
    const double density = std::exp(-0.5 * z * z) / std::pow(usual + s, 2);
    sum += density;
    weighted += density * s;
  }
  return weighted / sum;
}

TEST(ShiftEvidence, LikelySignalIsTheMeanOfThePosterior) {
  for (const double signal : {-1.0, 0.0, 2.0, 5.0, 20.0}) {
    const double expected = meanByIntegration(signal, 1, 10);
    EXPECT_NEAR(measured(signal, 1, 10).likelySignal(), expected, 0.03 * expected) << signal;
  }
}

TEST(ShiftEvidence, LikelySignalIsPositiveHoweverUnlikelyTheMeasurement) {
  for (const double signal : {-3.0, -10.0, -1000.0}) {
    EXPECT_GT(measured(signal, 1, 2).likelySignal(), 0) << signal;
  }
}

TEST(ShiftEvidence, AddsUpEverything) {
  ShiftEvidence sum{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  sum.add({10, 20, 30, 40, 50, 60, 70, 80, 90, 100});
  EXPECT_EQ(sum.blocks, 11);
  EXPECT_EQ(sum.score, 22);
  EXPECT_EQ(sum.score_variance, 33);
  EXPECT_EQ(sum.energy, 44);
  EXPECT_EQ(sum.signal, 55);
  EXPECT_EQ(sum.signal_variance, 66);
  EXPECT_EQ(sum.usual, 77);
  EXPECT_EQ(sum.moment_u, 88);
  EXPECT_EQ(sum.moment_v, 99);
  EXPECT_EQ(sum.down, 110);
}

/// Eight weak blocks: each alone is uncertain, together they are not, and their shift is the common one.
TEST(ShiftEvidence, WeakBlocksAreCertainTogether) {
  constexpr double kSignal = 3, kShift = 0.2, kScoreStddev = 1;
  constexpr int kTrials = 400, kBlocks = 8;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double squares = 0;
  int certain_alone = 0, certain_together = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    ShiftEvidence together;
    for (int i = 0; i < kBlocks; ++i) {
      ShiftEvidence one = measured(kSignal + normal(random), 1, kSignal);
      one.score = kSignal * kShift + kScoreStddev * normal(random);
      one.score_variance = kScoreStddev * kScoreStddev;
      certain_alone += one.isCertain();
      together.add(one);
    }
    certain_together += together.isCertain();
    const double shift = together.score / together.likelySignal();
    const double stddev = std::sqrt(together.score_variance) / together.likelySignal();
    squares += std::pow((shift - kShift) / stddev, 2);
  }
  EXPECT_LT(certain_alone, 0.005 * kTrials * kBlocks);
  EXPECT_GT(certain_together, 0.98 * kTrials);
  EXPECT_NEAR(squares / kTrials, 1, 0.2);
}

}  // namespace
}  // namespace uav_landing
