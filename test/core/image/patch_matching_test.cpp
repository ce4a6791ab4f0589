#include "image/windows/patch_matching.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "image/windows/match_image.h"
#include "image/windows/patch_refiner.h"
#include "support/random_texture.h"

namespace uav_landing {
namespace {

constexpr int kSize = 200, kRadius = 5;

/// Two images, the reference's pixel x = centre + d seen in the other one at
/// centre + A d / (1 + perspective.d) + shift.
struct Pair {
  struct Look {
    Eigen::Matrix2d A = Eigen::Matrix2d::Identity();
    Eigen::Vector2d shift{0, 0}, perspective{0, 0};  // the latter per pixel
    double gain = 1, offset = 0, noise = 0;
    double contrast = 30;  // grey levels, 1 sigma
  };
  Look look;
  MatchImage reference, other;

  explicit Pair(const Look& given) : look(given) {
    const test::RandomTexture texture(3);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    cv::Mat first(kSize, kSize, CV_8UC1), second = first.clone();
    const auto light = [&](const Eigen::Vector2d& x) {
      return 110 + look.contrast * texture.at(x.x() / 3, x.y() / 3);
    };
    for (int v = 0; v < kSize; ++v)
      for (int u = 0; u < kSize; ++u) {
        const Eigen::Vector2d x(u, v);
        const Eigen::Vector2d affine = look.A.inverse() * (x - look.shift - centre());
        const Eigen::Vector2d source = centre() + affine / (1 - look.perspective.dot(affine));
        first.at<uchar>(v, u) = cv::saturate_cast<uchar>(light(x) + look.noise * normal(random));
        second.at<uchar>(v, u) =
            cv::saturate_cast<uchar>(look.gain * light(source) + look.offset + look.noise * normal(random));
      }
    reference.assign(first);
    other.assign(second);
  }

  static Eigen::Vector2d centre() { return {kSize / 2.0, kSize / 2.0}; }
  Eigen::Vector2d place(int u, int v) const {
    return centre() + look.A * (Eigen::Vector2d(u, v) - centre()) / nearness(u, v) + look.shift;
  }
  double nearness(int u, int v) const { return 1 + look.perspective.dot(Eigen::Vector2d(u, v) - centre()); }
  /// Of the surroundings of a pixel: derivative of place(), and the perspective in there.
  Eigen::Matrix2d warp(int u, int v) const {
    const Eigen::Vector2d there = place(u, v) - look.shift - centre();
    return (look.A - there * look.perspective.transpose()) / nearness(u, v);
  }
  Eigen::Vector2d perspective(int u, int v) const { return look.perspective / nearness(u, v); }
};

struct Errors {
  double rms = 0;   ///< of a component, pixels
  double nees = 0;  ///< mean normalised squared error
  int matched = 0, tried = 0;
};

/// Searches and refines a grid of patches from places 2.4 and -1.7 pixels off.
Errors matchGrid(const Pair& pair, const Eigen::Matrix2d& warp) {
  PatchSearch search(pair.reference.fine, pair.other.fine, kRadius);
  Errors errors;
  double squares = 0;
  for (int v = 40; v <= kSize - 40; v += 6)
    for (int u = 40; u <= kSize - 40; u += 6) {
      ++errors.tried;
      const Eigen::Vector2d wanted = pair.place(u, v);
      const PatchSearch::Best best = search.run(u, v, wanted + Eigen::Vector2d(2.4, -1.7), warp, 6);
      if (!best.found) continue;
      const PatchRefinement refined =
          refinePatch(pair.reference.fine, pair.other.fine, {u, v, kRadius}, {best.position, warp});
      if (!refined.converged) continue;
      const Eigen::Vector2d error = refined.position - wanted;
      ++errors.matched;
      squares += error.squaredNorm();
      errors.nees += error.dot(refined.claim().covariance.inverse() * error);
    }
  errors.rms = std::sqrt(squares / (2 * errors.matched));
  errors.nees /= errors.matched;
  return errors;
}

Eigen::Matrix2d turned(double angle, double scale_u, double scale_v) {
  return Eigen::Rotation2Dd(angle).toRotationMatrix() * Eigen::Vector2d(scale_u, scale_v).asDiagonal();
}

TEST(PatchMatching, FindsShiftsToSubPixelWhateverTheGainAndOffset) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(3.5, -2.5), Eigen::Vector2d(-1.23, 4.71)}) {
    Pair::Look look;
    look.shift = shift;
    look.gain = 0.8;
    look.offset = 20;
    look.noise = 1;
    const Errors errors = matchGrid(Pair(look), Eigen::Matrix2d::Identity());
    EXPECT_GT(errors.matched, 0.98 * errors.tried);
    EXPECT_LT(errors.rms, 0.03) << shift.transpose();
  }
}

TEST(PatchMatching, FindsWarpedPatchesWithTheirWarpOnly) {
  for (const Eigen::Matrix2d& A :
       {turned(0.15, 1, 1), turned(0, 0.8, 0.8), turned(0.05, 1.15, 1.3), turned(-0.1, 0.9, 0.7)}) {
    Pair::Look look;
    look.A = A;
    look.shift = {1.37, -0.62};
    look.noise = 1;
    const Pair pair(look);
    const Errors warped = matchGrid(pair, A), upright = matchGrid(pair, Eigen::Matrix2d::Identity());
    EXPECT_GT(warped.matched, 0.95 * warped.tried) << A;
    EXPECT_LT(warped.rms, 0.03) << A;
    EXPECT_GT(upright.rms, 2 * warped.rms) << A;
  }
}

TEST(RefinePatch, ClaimsTheScatterItHas) {
  for (const double noise : {1.0, 4.0}) {
    Pair::Look look;
    look.A = turned(0.05, 0.9, 1.1);
    look.shift = {0.4, 0.7};
    look.noise = noise;
    const Errors errors = matchGrid(Pair(look), look.A);
    // Factor two in the standard deviation; two components.
    EXPECT_LT(errors.nees, 2 * 4) << noise;
    EXPECT_GT(errors.nees, 2 / 4.0) << noise;
  }
}

TEST(RefinePatch, KnowsThatAnEdgeSaysNothingAlongIt) {
  // Brightness changes along u only, but for a little texture.
  const test::RandomTexture texture(5);
  cv::Mat image(kSize, kSize, CV_8UC1);
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      image.at<uchar>(v, u) =
          cv::saturate_cast<uchar>(100 + 60 * std::tanh((u - 100) / 2.0) + 3 * texture.at(u / 3.0, v / 3.0));
  MatchImage match;
  match.assign(image);
  cv::Mat noisy = image.clone(), noise(image.size(), CV_8UC1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 5);
  noisy += noise;
  MatchImage other;
  other.assign(noisy);
  const PatchRefinement refined =
      refinePatch(match.fine, other.fine, {100, 100, kRadius}, {{100.3, 100.2}, Eigen::Matrix2d::Identity()});
  ASSERT_TRUE(refined.converged);
  EXPECT_NEAR(refined.position.x(), 100, 0.1);
  EXPECT_GT(refined.claim().covariance(1, 1), 10 * refined.claim().covariance(0, 0));
  EXPECT_GT(refined.claim().covariance.determinant(), 0);
}

TEST(RefinePatch, DoesNotTakeNoiseAlongAnEdgeForTexture) {
  constexpr double kNoise = 5;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, kNoise);
  const auto edge = [&] {
    cv::Mat image(kSize, kSize, CV_8UC1);
    for (int v = 0; v < kSize; ++v)
      for (int u = 0; u < kSize; ++u)
        image.at<uchar>(v, u) =
            cv::saturate_cast<uchar>(100 + 60 * std::tanh((u - 100) / 2.0) + normal(random));
    MatchImage match;
    match.assign(image);
    return match;
  };
  const MatchImage reference = edge(), other = edge();
  // Wherever it is looked for, it is found near there: the claim must be no less than how far that may be
  // off.
  double squares = 0, normalised = 0;
  int found = 0;
  for (int v = 20; v < kSize - 20; v += 4) {
    const double off = v % 8 == 0 ? 1.0 : -1.0;
    const PatchRefinement refined = refinePatch(reference.fine, other.fine, {100, v, kRadius},
                                                {{100.0, v + off}, Eigen::Matrix2d::Identity()});
    if (!refined.converged) continue;
    ++found;
    const Eigen::Matrix2d covariance = refined.claim().covariance;
    const double error = refined.position.y() - v;
    squares += error * error;
    normalised += error * error / covariance(1, 1);
    EXPECT_LT(std::sqrt(covariance(0, 0)), 0.3);
  }
  ASSERT_GT(found, 10);
  EXPECT_GT(squares / found, 0.3);
  EXPECT_LT(normalised / found, 2);
}

TEST(RefinePatch, TellsHowThePlaceFollowsFromTheWarp) {
  Pair::Look look;
  look.A = turned(0.05, 0.9, 1.1);
  look.shift = {0.4, -0.7};
  look.noise = 0.5;
  const Pair pair(look);
  Eigen::Matrix2d E;
  E << 0.05, 0.02, -0.03, -0.06;
  double squares = 0, left = 0;
  for (int v = 40; v <= kSize - 40; v += 6)
    for (int u = 40; u <= kSize - 40; u += 6) {
      const Eigen::Vector2d wanted = pair.place(u, v);
      const PatchRefinement refined =
          refinePatch(pair.reference.fine, pair.other.fine, {u, v, kRadius}, {wanted, look.A + E});
      ASSERT_TRUE(refined.converged);
      const Eigen::Vector2d error = refined.position - wanted;
      const auto by_warp = refined.claim().by_warp;
      const Eigen::Vector2d told = -(by_warp[0] * E.col(0) + by_warp[1] * E.col(1));
      squares += error.squaredNorm();
      left += (error - told).squaredNorm();
    }
  EXPECT_LT(left, 0.1 * squares);
}

/// What perspective moves a grid of places by, as found and as told; per place.
struct ByPerspective {
  Eigen::Vector2d error = Eigen::Vector2d::Zero(), told = error;  ///< means
  double squares = 0, left = 0;                                   ///< sums, the latter of what is not told
};

ByPerspective movedByPerspective(const Pair& pair) {
  ByPerspective moved;
  int count = 0;
  for (int v = 40; v <= kSize - 40; v += 6)
    for (int u = 40; u <= kSize - 40; u += 6) {
      const Eigen::Vector2d wanted = pair.place(u, v);
      const PatchRefinement refined =
          refinePatch(pair.reference.fine, pair.other.fine, {u, v, kRadius}, {wanted, pair.warp(u, v)});
      if (!refined.converged) continue;
      const Eigen::Vector2d error = refined.position - wanted;
      EXPECT_TRUE(refined.covariance().isApprox(refined.claim().covariance));
      const Eigen::Vector2d told = -refined.claim().by_perspective * pair.perspective(u, v);
      moved.error += error;
      moved.told += told;
      moved.squares += error.squaredNorm();
      moved.left += (error - told).squaredNorm();
      ++count;
    }
  EXPECT_GT(count, 300);
  moved.error /= count;
  moved.told /= count;
  return moved;
}

Pair::Look perspectiveLook() {
  Pair::Look look;
  look.A = turned(0.05, 0.9, 1.1);
  look.shift = {0.4, -0.7};
  look.perspective = {0.002, -0.006};
  look.noise = 0.5;
  return look;
}

TEST(RefinePatch, TellsHowThePlaceFollowsFromThePerspective) {
  const ByPerspective moved = movedByPerspective(Pair(perspectiveLook()));
  EXPECT_GT(moved.error.norm(), 0.04);
  EXPECT_LT((moved.error - moved.told).norm(), 0.06 * moved.error.norm());
  EXPECT_LT(moved.left, 0.15 * moved.squares);
}

TEST(RefinePatch, DoesNotTakeNoiseForTextureThatPerspectiveMoves) {
  Pair::Look look = perspectiveLook();
  look.contrast = 10;
  look.noise = 0;
  const Eigen::Vector2d clear = movedByPerspective(Pair(look)).told;
  look.noise = 5;
  const Eigen::Vector2d noisy = movedByPerspective(Pair(look)).told;
  EXPECT_LT((noisy - clear).norm(), 0.08 * clear.norm());
}

TEST(PatchSearch, DoesNotTakeAPeakOnTheBorderOfTheRange) {
  Pair::Look look;
  look.shift = {6, 0};
  const Pair pair(look);
  PatchSearch search(pair.reference.fine, pair.other.fine, kRadius);
  const Eigen::Matrix2d upright = Eigen::Matrix2d::Identity();
  EXPECT_FALSE(search.run(100, 100, {100, 100}, upright, 6).found);
  const PatchSearch::Best best = search.run(100, 100, {100, 100}, upright, 8);
  EXPECT_TRUE(best.found);
  EXPECT_NEAR((best.position - Eigen::Vector2d(106, 100)).norm(), 0, 1e-9);
  EXPECT_GT(best.score, 0.99);
  EXPECT_LT(best.second, 0.9);
}

TEST(PatchSearch, ReportsASecondPlaceThatIsAsGood) {
  cv::Mat image(kSize, kSize, CV_32F);
  for (int v = 0; v < kSize; ++v)
    for (int u = 0; u < kSize; ++u)
      image.at<float>(v, u) =
          static_cast<float>(100 + 40 * std::sin(2 * M_PI * u / 8) * std::sin(2 * M_PI * v / 30));
  PatchSearch search(image, image, kRadius);
  const PatchSearch::Best best = search.run(100, 100, {100, 100}, Eigen::Matrix2d::Identity(), 10);
  EXPECT_GT(best.second, 0.99);
}

TEST(PatchMatching, SaysNoWithoutContrastAndOutsideTheImage) {
  const Pair pair{Pair::Look()};
  const cv::Mat flat(kSize, kSize, CV_32F, cv::Scalar(77));
  const Eigen::Matrix2d upright = Eigen::Matrix2d::Identity();
  PatchSearch from_flat(flat, pair.other.fine, kRadius), to_flat(pair.reference.fine, flat, kRadius);
  EXPECT_FALSE(from_flat.run(100, 100, {100, 100}, upright, 3).found);
  EXPECT_FALSE(to_flat.run(100, 100, {100, 100}, upright, 3).found);
  EXPECT_FALSE(refinePatch(flat, flat, {100, 100, kRadius}, {{100, 100}, upright}).converged);
  EXPECT_FALSE(refinePatch(pair.reference.fine, flat, {100, 100, kRadius}, {{100, 100}, upright}).converged);
  PatchSearch search(pair.reference.fine, pair.other.fine, kRadius);
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(2, 100), Eigen::Vector2d(100, kSize - 2), Eigen::Vector2d(-300, 100),
        Eigen::Vector2d(1e9, 1e9), Eigen::Vector2d(std::nan(""), 100)}) {
    EXPECT_FALSE(search.run(100, 100, at, upright, 3).found) << at.transpose();
    EXPECT_FALSE(
        refinePatch(pair.reference.fine, pair.other.fine, {100, 100, kRadius}, {at, upright}).converged)
        << at.transpose();
  }
  EXPECT_FALSE(search.run(3, 100, {100, 100}, upright, 3).found);
  EXPECT_FALSE(search.run(100, kSize, {100, 100}, upright, 3).found);
}

}  // namespace
}  // namespace uav_landing
