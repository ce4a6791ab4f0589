#include "stereo/matching/row_matching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/windows/match_image.h"
#include "stereo/matching/row_refinement.h"
#include "support/random_texture.h"

namespace uav_landing {
namespace {

constexpr int kWidth = 240, kHeight = 200, kRadius = 5;

/// A pair of which the right image shows the left pixel (u, v) at column u - shift(u, v) of the row v + down,
/// as smoothed as the stages smooth their images.
struct Pair {
  struct Look {
    double a = 0, b = 0, c = 20;  ///< shift = a u + b v + c
    double down = 0;
    double gain = 1, offset = 0, noise = 0;
    double detail = 3;  ///< lattice spacing of the texture, pixels
    unsigned seed = 1;
  };
  Look look;
  MatchImage left, right;

  explicit Pair(const Look& given) : look(given) {
    const test::RandomTexture texture(look.seed);
    std::mt19937 random(look.seed + 1000);
    std::normal_distribution<double> normal;
    cv::Mat first(kHeight, kWidth, CV_8UC1), second = first.clone();
    const auto light = [&](double u, double v) {
      return 110 + 30 * texture.at(u / look.detail, v / look.detail);
    };
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        // Column u of the right image shows the left column x with x - shift(x, v) = u.
        const double y = v - look.down, x = (u + look.b * y + look.c) / (1 - look.a);
        first.at<uchar>(v, u) = cv::saturate_cast<uchar>(light(u, v) + look.noise * normal(random));
        second.at<uchar>(v, u) =
            cv::saturate_cast<uchar>(look.gain * light(x, y) + look.offset + look.noise * normal(random));
      }
    left.assign(first);
    right.assign(second);
  }

  double column(int u, int v) const { return u - (look.a * u + look.b * v + look.c); }
  RowWarp warp() const { return {1 - look.a, -look.b}; }
};

/// Errors of matches on a grid, searched around a place that is wrong by 1.3 pixels.
struct Errors {
  std::vector<double> errors, normalised;
  int tried = 0;

  double rms() const { return rmsOf(errors); }
  double normalisedRms() const { return rmsOf(normalised); }
  static double rmsOf(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size()));
  }
};

template <class Match>
Errors matchGrid(const Pair& pair, const Match& match) {
  Errors result;
  for (int v = 20; v < kHeight - 20; v += 6)
    for (int u = 20; u < kWidth - 20; u += 6) {
      const double wanted = pair.column(u, v);
      if (wanted < 16 || wanted > kWidth - 16) continue;
      ++result.tried;
      double found = 0, stddev = 1;
      if (!match(u, v, wanted + 1.3, &found, &stddev)) continue;
      result.errors.push_back(found - wanted);
      result.normalised.push_back((found - wanted) / stddev);
    }
  return result;
}

Errors search(const Pair& pair, MatchingCost cost, const RowWarp& warp) {
  RowSearch rows(pair.left.fine, pair.right.fine, kRadius, cost);
  return matchGrid(pair, [&](int u, int v, double near, double* found, double*) {
    if (!rows.run(u, v, near, 6, warp)) return false;
    const RowCandidate best = rows.best(nullptr);
    *found = best.position;
    return best.score > 0.5;
  });
}

Errors refine(const Pair& pair, const RowWarp& warp) {
  RowSearch rows(pair.left.fine, pair.right.fine, kRadius, MatchingCost::kZncc);
  return matchGrid(pair, [&](int u, int v, double near, double* found, double* stddev) {
    if (!rows.run(u, v, near, 6, warp)) return false;
    const RowRefinement refined =
        refineAlongRow(pair.left.fine, pair.right.fine, {u, v, kRadius}, {rows.best(nullptr).position, warp});
    *found = refined.position;
    *stddev = refined.stddev;
    return refined.converged;
  });
}

Pair::Look shifted(double shift) {
  Pair::Look look;
  look.c = shift;
  return look;
}

TEST(RefineAlongRow, FindsSubPixelShiftsWhateverTheGainAndOffset) {
  for (const double shift : {20.0, 20.21, 20.5, 20.77})
    for (const auto& [gain, offset] : {std::pair(1.0, 0.0), std::pair(0.8, 20.0), std::pair(1.2, -15.0)}) {
      Pair::Look look = shifted(shift);
      look.gain = gain;
      look.offset = offset;
      look.noise = 1;
      const Errors errors = refine(Pair(look), {});
      EXPECT_GT(errors.errors.size(), 0.99 * errors.tried);
      EXPECT_LT(errors.rms(), 0.03) << shift << " " << gain << " " << offset;
    }
}

TEST(RowSearch, FindsShiftsByZnccWhateverTheGainAndOffset) {
  Pair::Look look = shifted(20.3);
  const double plain = search(Pair(look), MatchingCost::kZncc, {}).rms();
  look.gain = 0.8;
  look.offset = 20;
  const Errors changed = search(Pair(look), MatchingCost::kZncc, {});
  EXPECT_EQ(changed.errors.size(), static_cast<size_t>(changed.tried));
  EXPECT_LT(changed.rms(), 0.1);
  EXPECT_NEAR(changed.rms(), plain, 0.01);
}

TEST(RowSearch, LosesMatchesBySsdWhenGainAndOffsetDiffer) {
  Pair::Look look = shifted(20.3);
  const Errors same = search(Pair(look), MatchingCost::kSsd, {});
  EXPECT_EQ(same.errors.size(), static_cast<size_t>(same.tried));
  EXPECT_LT(same.rms(), 0.1);
  look.gain = 0.8;
  look.offset = 20;
  const Errors changed = search(Pair(look), MatchingCost::kSsd, {});
  EXPECT_GT(changed.rms(), 2 * same.rms());
}

TEST(RowSearch, ScoresTheTruePlaceOneAndOthersLess) {
  const Pair pair(shifted(20));
  for (const MatchingCost cost : {MatchingCost::kZncc, MatchingCost::kSsd}) {
    RowSearch rows(pair.left.fine, pair.right.fine, kRadius, cost);
    ASSERT_TRUE(rows.run(120, 100, 103, 10, {}));
    double second = 0;
    const RowCandidate best = rows.best(&second);
    EXPECT_NEAR(best.score, 1, 1e-3);
    EXPECT_NEAR(best.position, 100, 0.02);
    EXPECT_LT(second, 0.9);
  }
}

/// Correlation or SSD score of a window at one place, written from the definition in double precision; -1
/// when it leaves the image.
double scoreAt(const Pair& pair, int u, int v, double column, const RowWarp& warp, int radius,
               MatchingCost cost) {
  std::vector<double> a, b;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const double x = column + warp.scale * dx + warp.shear * dy;
      if (x < 0 || x >= kWidth - 1) return -1;
      const float* row = pair.right.fine.ptr<float>(v + dy) + static_cast<int>(x);
      a.push_back(pair.left.fine.at<float>(v + dy, u + dx));
      b.push_back(row[0] + (x - std::floor(x)) * (row[1] - row[0]));
    }
  const double n = static_cast<double>(a.size());
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0, differences = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
    differences += std::pow(a[i] - b[i], 2);
  }
  for (size_t i = 0; i < a.size(); ++i) {
    aa += std::pow(a[i] - mean_a, 2);
    bb += std::pow(b[i] - mean_b, 2);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return cost == MatchingCost::kSsd ? 1 - differences / (2 * aa) : ab / std::sqrt(aa * bb);
}

TEST(RowSearch, ScoresAreThoseOfTheDefinitionForAllSizesUpToTheImagesBorder) {
  Pair::Look look = shifted(20.3);
  look.gain = 0.9;
  look.noise = 4;
  const Pair pair(look);
  for (const MatchingCost cost : {MatchingCost::kZncc, MatchingCost::kSsd})
    for (const int radius : {1, 2, 5, 7})
      for (const int steps : {0, 1, 3, 4, 6, 20})
        for (const RowWarp& warp : {RowWarp{1, 0}, RowWarp{0.93, 0.31}, RowWarp{1.08, -0.4}})
          for (const int u : {28, 120, 231}) {
            RowSearch rows(pair.left.fine, pair.right.fine, radius, cost);
            const double centre = u - 19.6;
            ASSERT_TRUE(rows.run(u, 100, centre, steps, warp));
            double expected = -1;
            for (int k = -steps; k <= steps; ++k)
              expected =
                  std::max(expected, scoreAt(pair, u, 100, centre + k * warp.scale, warp, radius, cost));
            EXPECT_NEAR(rows.best(nullptr).score, expected, 2e-3)
                << u << ' ' << radius << ' ' << steps << ' ' << warp.scale;
          }
}

TEST(Warp, IsNeededForAGroundPlaneAndWorks) {
  // Disparity that changes by 0.4 a row, as on low ground, and by 0.05 a column, as with roll.
  Pair::Look look;
  look.a = 0.05;
  look.b = 0.4;
  look.c = -20;
  look.noise = 1;
  const Pair pair(look);
  const Errors warped = refine(pair, pair.warp()), upright = refine(pair, {});
  EXPECT_GT(warped.errors.size(), 0.99 * warped.tried);
  EXPECT_LT(warped.rms(), 0.03);
  EXPECT_GT(upright.rms(), 3 * warped.rms());
}

TEST(RowSearch, GivesAllPlacesOfARepeatedTexture) {
  // Bars with a period of 14 columns that differ from each other nowhere.
  cv::Mat image(60, 200, CV_32F);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<float>(v, u) = static_cast<float>(100 + 40 * std::sin(2 * M_PI * u / 14));
  RowSearch rows(image, image, kRadius, MatchingCost::kZncc);
  ASSERT_TRUE(rows.run(100, 30, 100, 31, {}));
  std::vector<RowCandidate> peaks = rows.peaks(0.9, 10);
  ASSERT_EQ(peaks.size(), 5U);
  std::sort(peaks.begin(), peaks.end(), [](auto& a, auto& b) { return a.position < b.position; });
  // A window shorter than the period correlates along a curve that is not quite symmetric.
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(peaks[k].position, 100 + 14 * (k - 2), 0.25);
  double second = 0;
  rows.best(&second);
  EXPECT_GT(second, 0.99);
  EXPECT_EQ(rows.peaks(0.9, 3).size(), 3U);
}

TEST(RefineAlongRow, ClaimsTheScatterItHas) {
  for (const double noise : {1.0, 3.0, 6.0})
    for (const double detail : {2.0, 4.0}) {
      Pair::Look look = shifted(20.4);
      look.noise = noise;
      look.gain = 0.9;
      look.detail = detail;
      const Errors errors = refine(Pair(look), {});
      EXPECT_GT(errors.normalisedRms(), 0.5) << noise << " " << detail;
      EXPECT_LT(errors.normalisedRms(), 2.0) << noise << " " << detail;
    }
}

/// Rows of matches on a grid that are found across them, about what they are off by.
Errors refineAcross(const Pair& pair) {
  Errors result;
  const double down = pair.look.down;
  for (int v = 20; v < kHeight - 20; v += 6)
    for (int u = 50; u < kWidth - 20; u += 6) {
      const RowRefinement refined = refineAlongRow(pair.left.fine, pair.right.fine, {u, v, kRadius},
                                                   {pair.column(u, v), pair.warp()}, true);
      ++result.tried;
      if (!refined.across.found || refined.across.score < 0.8) continue;
      const double error = refined.across.place.y() - v - down;
      result.errors.push_back(error);
      result.normalised.push_back(error / std::sqrt(refined.across.row_variance));
    }
  return result;
}

TEST(RefineAlongRow, FindsHowFarTheRowHasMoved) {
  for (const double down : {0.0, 0.04, -0.3, 0.7, -1.2}) {
    Pair::Look look = shifted(20.3);
    look.noise = 3;
    look.gain = 0.9;
    look.down = down;
    const Errors errors = refineAcross(Pair(look));
    EXPECT_GT(errors.errors.size(), 0.9 * errors.tried) << down;
    EXPECT_LT(errors.rms(), 0.1) << down;
    EXPECT_GT(errors.normalisedRms(), 0.5) << down;
    EXPECT_LT(errors.normalisedRms(), 1.5) << down;
    double mean = 0;
    for (const double error : errors.errors) mean += error / static_cast<double>(errors.errors.size());
    EXPECT_NEAR(mean, 0, 0.01) << down;
  }
}

TEST(RefineAlongRow, SaysNoWhereTheRowIsFarAway) {
  Pair::Look look = shifted(20.3);
  look.down = 4;
  const Errors errors = refineAcross(Pair(look));
  EXPECT_LT(errors.errors.size(), 0.02 * errors.tried);
}

TEST(RefineAlongRow, LooksAcrossWhenAskedOnly) {
  const Pair pair(shifted(20.3));
  const RowRefinement refined =
      refineAlongRow(pair.left.fine, pair.right.fine, {100, 100, kRadius}, {pair.column(100, 100), {}});
  EXPECT_TRUE(refined.converged);
  EXPECT_FALSE(refined.across.found);
}

TEST(RowMatching, SaysNoWithoutContrastAndOutsideTheImage) {
  const Pair pair(shifted(20));
  const cv::Mat flat(kHeight, kWidth, CV_32F, cv::Scalar(77));
  RowSearch nothing(flat, pair.right.fine, kRadius, MatchingCost::kZncc);
  EXPECT_FALSE(nothing.run(100, 100, 80, 3, {}));
  EXPECT_FALSE(refineAlongRow(flat, flat, {100, 100, kRadius}, {80, {}}).converged);
  RowSearch rows(pair.left.fine, pair.right.fine, kRadius, MatchingCost::kZncc);
  for (const cv::Point p : {cv::Point(4, 100), cv::Point(100, 4), cv::Point(kWidth - 5, 100),
                            cv::Point(100, kHeight - 5), cv::Point(-50, 100)}) {
    EXPECT_FALSE(rows.run(p.x, p.y, 80, 3, {})) << p;
    EXPECT_FALSE(refineAlongRow(pair.left.fine, pair.right.fine, {p.x, p.y, kRadius}, {80, {}}).converged)
        << p;
  }
  // Wholly or partly outside the other image.
  for (const double centre : {-40.0, 2.0, kWidth - 2.0, kWidth + 40.0}) {
    EXPECT_FALSE(
        refineAlongRow(pair.left.fine, pair.right.fine, {100, 100, kRadius}, {centre, {}}).converged);
    EXPECT_TRUE(!rows.run(100, 100, centre, 1, {}) || rows.best(nullptr).score <= -1) << centre;
  }
}

}  // namespace
}  // namespace uav_landing
