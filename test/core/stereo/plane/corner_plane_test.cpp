#include "stereo/plane/corner_plane.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <utility>

#include "geometry/bias_variance.h"
#include "image/input/image_cells.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kBias = 0.02, kNoise = 0.05;  // pixels
constexpr int kWindow = 11;

StereoRig rig() { return test::usualRig(); }

const Eigen::Vector3d kPlane(0, 0.1, 0.01);

PlaneLimits limits() { return {0.5, 0.5, 20, 0.6}; }

/// Corners on a lattice, farther from each other than windows are wide.
std::vector<DisparitySample> corners(std::mt19937& random, double step, double common) {
  std::normal_distribution<double> normal;
  std::array<double, kImageCells> shared{};
  for (double& error : shared) error = common * normal(random);
  std::vector<DisparitySample> samples;
  for (double v = 260; v < 470; v += step)
    for (double u = 20; u < 620; u += step) {
      const double disparity = rig().fb() * kPlane.dot(rig().ray(u, v));
      samples.push_back({u, v, kNoise, disparity + kNoise * normal(random) + shared[imageCell(rig(), u, v)]});
    }
  return samples;
}

MatchedCorners fitted(std::vector<DisparitySample> samples) {
  PlaneFit fit =
      fitCorners(rig(), {samples, kBias}, static_cast<int>(samples.size()), PlaneVector(kPlane), limits())
          .value();
  return {{}, {std::move(samples), {}}, std::move(fit)};
}

/// Of the plane without the bias.
Eigen::Matrix3d ownCovariance(const PlaneFit& fit) {
  Eigen::Matrix3d own = fit.plane.covariance;
  own(2, 2) -= biasVariance(rig(), kBias);
  return own;
}

/// Covariance of the plane vectors fitted, and the mean of what is claimed, both without the bias; with what
/// corners share or without it.
struct Scatter {
  Eigen::Matrix3d real = Eigen::Matrix3d::Zero(), claimed = real, with_shared = real;
};
Scatter scatter(double step, double common) {
  constexpr int kTimes = 300;
  std::mt19937 random(1);
  Scatter result;
  for (int i = 0; i < kTimes; ++i) {
    const MatchedCorners found = fitted(corners(random, step, common));
    const Eigen::Vector3d error = found.fit.plane.g - kPlane;
    const Eigen::Matrix3d claimed = ownCovariance(found.fit);
    result.real += error * error.transpose() / kTimes;
    result.claimed += claimed / kTimes;
    result.with_shared += (claimed + sharedCovariance(rig(), found, kWindow, kBias)) / kTimes;
  }
  return result;
}

TEST(CornerPlane, IndependentErrorsAreClaimedOnce) {
  const Scatter found = scatter(20, 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(found.claimed(i, i), 0.9 * found.real(i, i)) << i;
    EXPECT_LT(found.claimed(i, i), 1.5 * found.real(i, i)) << i;
    EXPECT_GE(found.with_shared(i, i), found.claimed(i, i)) << i;
    EXPECT_LT(found.with_shared(i, i), 2.2 * found.real(i, i)) << i;  // some of it is there by chance
  }
}

TEST(CornerPlane, ErrorsOfPartsOfTheImageAreClaimed) {
  const Scatter found = scatter(20, kNoise);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(found.claimed(i, i), 0.5 * found.real(i, i)) << i;
    EXPECT_GT(found.with_shared(i, i), 0.5 * found.real(i, i)) << i;  // a dozen parts tell three unknowns
    EXPECT_LT(found.with_shared(i, i), 1.5 * found.real(i, i)) << i;
  }
}

TEST(CornerPlane, WindowsThatOverlapAreClaimedFor) {
  std::mt19937 random(2);
  const MatchedCorners found = fitted(corners(random, 5.5, 0));  // half of a window from each other
  const Eigen::Matrix3d shared = sharedCovariance(rig(), found, kWindow, kBias);
  const Eigen::Matrix3d without = sharedCovariance(rig(), found, 1, kBias);
  // Of one on a lattice of half a window's width: itself, four beside it by half, four aslant by a quarter.
  const double factor = 1 + 4.0 / 2 + 4.0 / 4;
  EXPECT_NEAR((shared - without).trace() / ownCovariance(found.fit).trace(), factor - 1, 0.1);
}

TEST(CornerPlane, IsThatOfMostCornersWhereverItWasExpected) {
  std::mt19937 random(4);
  std::vector<DisparitySample> samples = corners(random, 20, 0);
  for (DisparitySample& sample : samples) sample.stddev *= 0.6;  // claimed less than they scatter
  const auto count = static_cast<int>(samples.size());
  const Eigen::Vector3d there =
      fitCorners(rig(), {samples, kBias}, count, PlaneVector(kPlane), limits())->plane.g;
  // Pixels, by which nearer and farther planes were expected; small ones may be where nothing is drawn.
  for (const double off : {-20.0, -1.0, -0.3, -0.25, -0.1, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 1.0, 20.0}) {
    const Eigen::Vector3d expected = kPlane - off / rig().fb() * Eigen::Vector3d::UnitZ();
    const Expected<PlaneFit> found =
        fitCorners(rig(), {samples, kBias}, count, PlaneVector(expected), limits());
    ASSERT_TRUE(found) << off << ": " << found.error().message();
    EXPECT_LT((found->plane.g - there).norm(), 0.1 * std::sqrt(found->plane.covariance.trace())) << off;
  }
  // A third of the corners on the plane expected does not keep it there.
  std::vector<DisparitySample> mixed = samples;
  for (size_t i = 0; i < mixed.size(); i += 3) mixed[i].disparity *= 0.8;
  const Expected<PlaneFit> found =
      fitCorners(rig(), {mixed, kBias}, count, PlaneVector(0.8 * kPlane), limits());
  ASSERT_TRUE(found);
  EXPECT_LT((found->plane.g - kPlane).norm(), 0.01 * kPlane.norm());
}

TEST(CornerPlane, SaysThatThereIsNone) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anything(1, 60);
  std::vector<DisparitySample> samples = corners(random, 20, 0);
  for (DisparitySample& sample : samples) sample.disparity = anything(random);
  const auto reason = [&](int corners) {
    return fitCorners(rig(), {samples, kBias}, corners, PlaneVector(kPlane), limits()).error().reason;
  };
  EXPECT_EQ(reason(500), Reason::kNoPlane);
  samples.resize(19);
  EXPECT_EQ(reason(500), Reason::kTooFewMatches);
  EXPECT_EQ(reason(19), Reason::kTooFewFeatures);
}

}  // namespace
}  // namespace uav_landing
