#include "stereo/photometric/sample_stddevs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kQuiet = 0.05, kNoisy = 0.5;  // 1 sigma of the noise, pixels

/// What becomes of the stddevs of samples, half of them quiet, half noisy, on average over many draws.
struct Outcome {
  double factor = 0;  // on the noise
  double common = 0;  // variance of the error that all have, pixels^2
  double told = 0;    // the same as returned
};

/// noise: how many times its 1 sigma is as large as the samples say. common: 1 sigma of an error besides.
Outcome outcomeOf(double noise, double common, double least_factor = 0) {
  constexpr int kDraws = 300, kSamples = 400;
  const StereoRig rig = test::makeRig(640, 480, 0.65);
  const test::Pose pose = test::makePose(4, -8, 3);
  const Eigen::Vector3d g = pose.down() / pose.height();
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> across(0, 639), down(240, 479);
  Outcome outcome;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<DisparitySample> samples;
    for (int i = 0; i < kSamples; ++i) {
      const double u = across(random), v = down(random);
      const double stddev = (i % 2 == 0 ? kQuiet : kNoisy) * (1 + 1e-4 * i);  // no two alike
      const double error = noise * stddev * normal(random) + common * normal(random);
      samples.push_back({u, v, stddev, rig.fb() * g.dot(rig.ray(u, v)) + error});
    }
    outcome.told += makeStddevsTrue(rig, PlaneVector(g), least_factor, samples) / kDraws;
    // Next to no error besides shows in the noisy ones.
    const double factor = samples[1].stddev / kNoisy;
    outcome.factor += factor / kDraws;
    outcome.common += (std::pow(samples[0].stddev, 2) - std::pow(factor * kQuiet, 2)) / kDraws;
  }
  return outcome;
}

TEST(SampleStddevs, StayAsTheyAreWhenTheyAreTrue) {
  const Outcome outcome = outcomeOf(1, 0);
  EXPECT_NEAR(outcome.factor, 1, 0.05);
  EXPECT_LT(outcome.common, 0.15 * kQuiet * kQuiet) << "noise alone, seen as an error besides";
}

TEST(SampleStddevs, GrowWithNoiseThatIsLargerThanTheySay) {
  const Outcome outcome = outcomeOf(1.5, 0);
  EXPECT_NEAR(outcome.factor, 1.5, 0.1);
  EXPECT_LT(outcome.common, 0.15 * std::pow(1.5 * kQuiet, 2));
}

TEST(SampleStddevs, ShrinkWhereSamplesScatterLessUnlessTheyHaveErrorsInCommon) {
  EXPECT_NEAR(outcomeOf(0.7, 0).factor, 0.7, 0.05);
  EXPECT_NEAR(outcomeOf(0.7, 0, 1).factor, 1, 0.01);
}

TEST(SampleStddevs, TakeInAnErrorBesidesTheNoise) {
  constexpr double kCommon = 0.2;
  const Outcome outcome = outcomeOf(1, kCommon);
  EXPECT_NEAR(std::sqrt(outcome.common), kCommon, 0.15 * kCommon);
  EXPECT_NEAR(outcome.told, outcome.common, 0.1 * outcome.common);
}

}  // namespace
}  // namespace uav_landing
