#include "motion/path/path_angle_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kRate = 20;                    // Hz
constexpr double kStepNoise = 0.1 * kDegree;    // of one step
constexpr double kChordNoise = 0.02 * kDegree;  // of half a second

struct Outcome {
  double squares_over_variance = 0, squares = 0, lag_sum = 0;
  int count = 0;
  double rms() const { return std::sqrt(squares / count); }
};

// Vibration that turns the rows of each image. It is told only that rows have times.
struct Vibrating {
  double error = 0;  // 1 sigma of an image's, rad s
  bool rolling = true;
};

// Feeds steps and chords of a path whose angle at time t is given, and compares with the truth of the last
// step.
Outcome follow(const std::function<double(double)>& angle, double duration, double from, unsigned seed,
               const Vibrating& vibrating = {0, false}) {
  PathAngleFilter filter(0.5);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> truths, of_images = {vibrating.error * normal(random)};
  Outcome outcome;
  for (int k = 1; k <= duration * kRate; ++k) {
    const double now = k / kRate;
    truths.push_back(angle(now - 0.5 / kRate));
    PathAngleFilter::Measurement step{truths.back() + kStepNoise * normal(random), kStepNoise * kStepNoise,
                                      1 / kRate};
    if (vibrating.error > 0) of_images.push_back(vibrating.error * normal(random));
    step.angle += vibrating.error > 0 ? (of_images[k] - of_images[k - 1]) * kRate : 0;
    step.rolling = vibrating.rolling;
    PathAngleFilter::Measurement chord = step;
    if (truths.size() >= 10) {
      double mean = 0;
      for (int i = 0; i < 10; ++i) mean += truths[truths.size() - 1 - i] / 10;
      chord = {mean + kChordNoise * normal(random), kChordNoise * kChordNoise, 0.5};
      if (vibrating.error > 0) chord.angle += (of_images[k] - of_images[k - 10]) / 0.5;
    }
    const PathAngleFilter::Estimate estimate = filter.update(now, step, chord);
    if (now < from) continue;
    const double error = estimate.angle - truths.back();
    outcome.squares += error * error;
    outcome.squares_over_variance += error * error / estimate.variance;
    outcome.lag_sum += error;
    ++outcome.count;
  }
  return outcome;
}

double gusts(double t) { return (4 + 0.4 * std::sin(2.5 * t) + 0.2 * std::sin(6.1 * t)) * kDegree; }

/// 5 degrees down to 0.5 in three seconds; a chord would be a quarter of a second late, 0.375 degrees.
double flare(double t) { return (t < 4 ? 5.0 : t < 7 ? 5.0 - 1.5 * (t - 4) : 0.5) * kDegree; }

/// Flares, while the angle changes.
Outcome followFlares(const Vibrating& vibrating) {
  Outcome during;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Outcome one = follow(flare, 7, 4.6, seed, vibrating);
    during.squares += one.squares;
    during.squares_over_variance += one.squares_over_variance;
    during.lag_sum += one.lag_sum;
    during.count += one.count;
  }
  return during;
}

TEST(PathAngleFilter, IsNearlyAsAccurateAsTheChordOnASteadyGlide) {
  const Outcome glide = follow([](double) { return 5 * kDegree; }, 60, 3, 1);
  // Chord and the mean of ten steps together: 1 / (1 / 0.02^2 + 10 / 0.1^2) = (0.0169 deg)^2.
  EXPECT_LT(glide.rms(), 1.6 * 0.0169 * kDegree);
}

TEST(PathAngleFilter, DoesNotAverageAwayWhatAReadoutTimeDoesToAll) {
  // 0.1 deg in steps and chords alike, with a sign: 200 pairs know no more of it than one.
  constexpr double kAlike = 0.1 * kDegree;
  for (const double sign : {1.0, -1.0}) {
    PathAngleFilter filter(0.5);
    PathAngleFilter::Estimate estimate;
    for (int k = 1; k <= 200; ++k) {
      PathAngleFilter::Measurement step{5 * kDegree, kStepNoise * kStepNoise, 1 / kRate};
      PathAngleFilter::Measurement chord{5 * kDegree, kChordNoise * kChordNoise, 0.5};
      step.by_readout = chord.by_readout = sign * kAlike;
      estimate = filter.update(k / kRate, step, k < 10 ? step : chord);
    }
    EXPECT_GT(std::sqrt(estimate.variance), kAlike);
    EXPECT_LT(std::sqrt(estimate.variance), 1.1 * kAlike);
  }
}

TEST(PathAngleFilter, DoesNotLagThroughAFlare) {
  const Outcome during = followFlares({0, false});
  EXPECT_LT(during.rms(), kStepNoise);
  EXPECT_LT(std::abs(during.lag_sum / during.count), 1.5 * kDegree * 0.04)
      << "mean error beyond 0.04 s of lag";
}

TEST(PathAngleFilter, ClaimsATrueVarianceInGusts) {
  const Outcome outcome = follow(gusts, 120, 3, 7);
  const double mean_square = outcome.squares_over_variance / outcome.count;
  EXPECT_GT(mean_square, 0.6);
  EXPECT_LT(mean_square, 1.5);
  EXPECT_LT(outcome.rms(), kStepNoise);
}

TEST(PathAngleFilter, ClaimsWhatVibrationDoesToARollingShutter) {
  const auto glide = [](double) { return 5 * kDegree; };
  for (const double error : {0.01 * kDegree, 0.04 * kDegree, 0.2 * kDegree}) {
    const Outcome told = follow(glide, 120, 1, 3, {error}),
                  not_told = follow(glide, 120, 1, 3, {error, false});
    EXPECT_LT(told.squares_over_variance / told.count, 1.5) << error / kDegree;
    EXPECT_GT(told.squares_over_variance / told.count, 0.35) << error / kDegree;
    EXPECT_LT(told.rms(), not_told.rms());
    EXPECT_GT(not_told.squares_over_variance / not_told.count, 2);
  }
}

TEST(PathAngleFilter, RowsThatDoNotShakeCostLittle) {
  const Outcome rolling = follow(gusts, 120, 3, 7, {0}), global = follow(gusts, 120, 3, 7);
  EXPECT_LT(rolling.rms(), 1.1 * global.rms());
  EXPECT_GT(rolling.squares_over_variance / rolling.count, 0.5);
  EXPECT_LT(rolling.squares_over_variance / rolling.count, 1.5);
}

TEST(PathAngleFilter, TakesNoFlareForVibration) {
  const Outcome during = followFlares({0});
  EXPECT_LT(during.rms(), kStepNoise);
  EXPECT_LT(std::abs(during.lag_sum / during.count), 1.5 * kDegree * 0.04);
  EXPECT_LT(during.squares_over_variance / during.count, 1.5);
}

/// Errors of a steady glide's angle and its claim after 0.7 s, over many runs, where the ground's normal is
/// wrong. The filter is told by how much that is in the steps (of even and odd numbers) and in the chord.
struct WrongNormal {
  double even = 0.05 * kDegree, odd = 0.05 * kDegree, chord = 0.005 * kDegree;  // 1 sigma, rad
  bool same_in_all = true;  // else each pair's is another one, and the chord's that of the last
  bool told = true;

  struct Result {
    double rms, ratio;  // rad; mean of squared errors over variances
  };
  Result run() const {
    constexpr int kRuns = 400;
    Result result{0, 0};
    for (unsigned seed = 0; seed < kRuns; ++seed) {
      const auto [error, variance] = follow(seed);
      result.rms += error * error / kRuns;
      result.ratio += error * error / variance / kRuns;
    }
    result.rms = std::sqrt(result.rms);
    return result;
  }

 private:
  std::pair<double, double> follow(unsigned seed) const {
    constexpr double kGlide = 4 * kDegree;
    PathAngleFilter filter(0.5);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    PathAngleFilter::Estimate estimate;
    double tilt = normal(random);
    for (int k = 1; k <= 14; ++k) {
      if (!same_in_all) tilt = normal(random);
      const double by_normal = k % 2 == 0 ? even : odd;
      const auto measured = [&](double by, double noise, double duration) {
        return PathAngleFilter::Measurement{kGlide + noise * normal(random) + by * tilt, noise * noise,
                                            duration, told ? std::abs(by) : 0};
      };
      const PathAngleFilter::Measurement step = measured(by_normal, kStepNoise, 1 / kRate);
      estimate = filter.update(k / kRate, step, k < 10 ? step : measured(chord, kChordNoise, 0.5));
    }
    return {estimate.angle - kGlide, estimate.variance};
  }
};

TEST(PathAngleFilter, KnowsThatTheErrorOfTheNormalIsInAllStepsAndHardlyInTheChord) {
  WrongNormal normal;
  const WrongNormal::Result told = normal.run();
  normal.told = false;
  EXPECT_LT(told.rms, 0.9 * normal.run().rms);
  // Of a glide that may have been a gust for all the filter knows.
  EXPECT_LT(told.ratio, 1);
  EXPECT_GT(told.ratio, 0.25);
}

TEST(PathAngleFilter, DoesNotThinkThatDifferencesTellTheNormal) {
  WrongNormal normal;
  normal.even = 0.02 * kDegree;
  normal.odd = 0.2 * kDegree;
  normal.chord = 0.1 * kDegree;
  EXPECT_LT(normal.run().ratio, 1.1);
  normal.same_in_all = false;
  EXPECT_LT(normal.run().ratio, 1.1) << "another normal in each pair";
  normal.chord *= -1;
  EXPECT_LT(normal.run().ratio, 1.1) << "which the chord follows the other way";
}

TEST(PathAngleFilter, AfterAGapClaimsWhatThePathMayHaveDoneSince) {
  const auto flare = [](double t) { return (6 - 2 * t) * kDegree; };
  PathAngleFilter filter(0.5);
  PathAngleFilter::Estimate estimate;
  double now = 0;
  const auto step = [&](double duration) {
    now += duration;
    const PathAngleFilter::Measurement middle{flare(now - 0.5 * duration), std::pow(0.03 * kDegree, 2),
                                              duration};
    estimate = filter.update(now, middle, middle);
  };
  while (now < 2) step(0.05);
  EXPECT_LT(std::sqrt(estimate.variance), 0.05 * kDegree);
  step(0.5);
  const double error = std::abs(estimate.angle - flare(now - 0.025));
  ASSERT_GT(error, 0.4 * kDegree) << "the middle of the gap is as long ago";
  EXPECT_LT(error, 2 * std::sqrt(estimate.variance));
}

TEST(PathAngleFilter, ClaimsATrueVarianceAfterAGap) {
  // Paths whose rate is one of the filter's own models: 3 deg/s, correlated over a second. A step's angle is
  // the mean over it.
  constexpr double kFine = 0.005, kUsual = 0.05, kGap = 0.4, kNoise = 0.02 * kDegree;
  constexpr int kRuns = 1500;
  double ratio = 0;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> path{5 * kDegree};
    double rate = 3 * kDegree * normal(random);
    for (int i = 0; i * kFine < 2 + kGap; ++i) {
      rate = rate * std::exp(-kFine) + 3 * kDegree * std::sqrt(1 - std::exp(-2 * kFine)) * normal(random);
      path.push_back(path.back() + rate * kFine);
    }
    const auto mean = [&](double from, double to) {
      double sum = 0;
      int count = 0;
      for (int i = static_cast<int>(std::lround(from / kFine)); i <= std::lround(to / kFine); ++i, ++count)
        sum += path[i];
      return sum / count;
    };
    PathAngleFilter filter(0.5);
    PathAngleFilter::Estimate estimate;
    const auto step = [&](double until, double duration) {
      const PathAngleFilter::Measurement measured{mean(until - duration, until) + kNoise * normal(random),
                                                  kNoise * kNoise, duration};
      estimate = filter.update(until, measured, measured);
    };
    for (int k = 1; k <= 40; ++k) step(k * kUsual, kUsual);
    step(2 + kGap, kGap);
    const double truth = mean(2 + kGap - kUsual, 2 + kGap);
    ratio += std::pow(estimate.angle - truth, 2) / estimate.variance / kRuns;
  }
  EXPECT_GT(ratio, 0.6);
  EXPECT_LT(ratio, 1.6);
}

TEST(PathAngleFilter, GivesTheFirstStepAsItIs) {
  PathAngleFilter filter(0.5);
  const PathAngleFilter::Measurement step{0.07, 1e-6, 0.05};
  const PathAngleFilter::Estimate estimate = filter.update(10.0, step, step);
  EXPECT_NEAR(estimate.angle, 0.07, 1e-5);
  EXPECT_NEAR(estimate.variance, 1e-6, 1e-8);
}

TEST(PathAngleFilter, KeepsNoMoreStepsThanItCanHandleHoweverCloseTheyAre) {
  // A camera driver that counts nanoseconds: all of them are within the window. The work of an update grows
  // with the cube of the steps, so that without a bound this would run for hours.
  PathAngleFilter filter(0.5);
  PathAngleFilter::Estimate estimate;
  for (int k = 1; k < 2000; ++k)
    estimate = filter.update(10 + 1e-9 * k, {0.1, 1e-4, 1e-9}, {0.1, 1e-4, 1e-9});
  EXPECT_NEAR(estimate.angle, 0.1, 1e-6);
}

TEST(PathAngleFilter, ForgetsWhatWasBeforeAReset) {
  PathAngleFilter filter(0.5);
  for (int k = 1; k < 40; ++k) filter.update(0.05 * k, {0.1, 1e-8, 0.05}, {0.1, 1e-8, 0.05});
  filter.reset();
  const PathAngleFilter::Measurement step{-0.02, 1e-6, 0.05};
  EXPECT_NEAR(filter.update(2.0, step, step).angle, -0.02, 1e-5);
}

TEST(PathAngleFilter, IsAsNewAfterAReset) {
  // Before it gusts in short steps, which make a fast rate likely and longer steps a gap.
  PathAngleFilter used(0.5), fresh(0.5);
  for (int k = 1; k < 60; ++k) {
    const PathAngleFilter::Measurement gust{0.1 * std::sin(1.0 * k), 1e-8, 0.02};
    used.update(0.02 * k, gust, gust);
  }
  used.reset();
  for (int k = 1; k < 8; ++k) {
    const PathAngleFilter::Measurement step{0.05 + 1e-4 * k, 1e-6, 0.1};
    const PathAngleFilter::Estimate again = used.update(2 + 0.1 * k, step, step),
                                    first = fresh.update(2 + 0.1 * k, step, step);
    EXPECT_EQ(again.angle, first.angle) << k;
    EXPECT_EQ(again.variance, first.variance) << k;
    EXPECT_EQ(again.rate_stddev, first.rate_stddev) << k;
  }
}

}  // namespace
}  // namespace uav_landing
