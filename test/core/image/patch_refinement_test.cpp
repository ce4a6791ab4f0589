#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "image/windows/patch_refiner.h"

namespace uav_landing {
namespace {

constexpr double kResidual = 9, kNoise = 4;  // grey levels^2
constexpr int kPixels = 121;

/// A window whose gradients' products have these sums along two axes that are turned by an angle, rad.
PatchRefinement found(double along, double across, double turned) {
  const Eigen::Matrix2d axes = Eigen::Rotation2Dd(turned).toRotationMatrix();
  PatchRefinement refinement;
  refinement.residual_variance = kResidual;
  refinement.warp.setIdentity();
  refinement.evidence.gradient = axes * Eigen::Vector2d(along, across).asDiagonal() * axes.transpose();
  refinement.evidence.by_gain.setZero();
  refinement.evidence.contrast = 1;
  refinement.evidence.count = kPixels;
  return refinement;
}

/// Variance along an axis of the texture with these sums: of the texture alone a place is told, but noise of
/// all of it moves it. One in five pixels is independent, and smoothed noise has 0.45 of its variance as
/// gradient.
double varianceAlong(double sum) {
  const double of_texture = std::max(sum - kPixels * 0.45 * kNoise, 0.1 * sum);
  return kResidual / 0.2 * sum / (of_texture * of_texture);
}

TEST(PatchRefinement, ClaimsEachAxisOfTheTextureByWhatIsNotNoise) {
  for (const double turned : {0.0, 0.3, M_PI / 4, 1.2, M_PI / 2, -2.0})
    for (const double along : {300.0, 5000.0, 5e6})
      for (const double across : {250.0, 300.0, 5000.0}) {
        const Eigen::Matrix2d axes = Eigen::Rotation2Dd(turned).toRotationMatrix();
        const Eigen::Matrix2d expected =
            axes * Eigen::Vector2d(varianceAlong(along), varianceAlong(across)).asDiagonal() *
            axes.transpose();
        const Eigen::Matrix2d claimed = found(along, across, turned).covariance(kNoise);
        EXPECT_LT((claimed - expected).norm(), 1e-6 * expected.norm())
            << along << " " << across << " " << turned << "\n"
            << claimed << "\n"
            << expected;
      }
}

TEST(PatchRefinement, ClaimsNoMoreNoiseThanHalfOfTheResiduals) {
  const PatchRefinement refinement = found(4000, 700, 0.4);
  EXPECT_EQ(refinement.covariance(10 * kResidual), refinement.covariance(0.5 * kResidual));
  EXPECT_NE(refinement.covariance(0), refinement.covariance(0.5 * kResidual));
}

}  // namespace
}  // namespace uav_landing
