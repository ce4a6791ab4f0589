#include "image/windows/patch_refinement.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// The gradient's products without those of noise, inverted; and the products of noise.
struct Texture {
  Eigen::Matrix2d inverse, noise;
};

// Noise has a gradient as well, but it tells nothing. Along a line there is no other gradient, so noise would
// seem to hold the match at the place where it was looked for.
Texture textureOf(const PatchRefinement& refined, double noise_variance) {
  const PatchRefinement::Evidence& evidence = refined.evidence;
  // Variance of the gradient over that of the smoothed noise: (1 - its correlation two pixels on) / 2.
  constexpr double kNoiseGradient = 0.45;
  // Smallest share of the gradients' energy that can be told from none, given its scatter.
  constexpr double kLeastTexture = 0.1;
  const double of_noise =
      evidence.count * kNoiseGradient * std::min(noise_variance, 0.5 * refined.residual_variance);
  const auto of_texture = [&](double seen) { return std::max(seen - of_noise, kLeastTexture * seen); };
  const Eigen::Matrix2d& A = evidence.gradient;
  const double mean = 0.5 * A.trace(),
               off = std::sqrt(0.25 * std::pow(A(0, 0) - A(1, 1), 2) + A(1, 0) * A(1, 0));
  const double most = of_texture(mean + off), least = of_texture(mean - off);
  // Any function of a matrix with two eigenvalues is linear in it, so no eigenvectors are needed.
  const auto of_matrix = [&](double of_most, double of_least) -> Eigen::Matrix2d {
    const double slope = off > 0 ? 0.5 * (of_most - of_least) / off : 0;
    return slope * A + (0.5 * (of_most + of_least) - slope * mean) * Eigen::Matrix2d::Identity();
  };
  return {of_matrix(1 / most, 1 / least), of_matrix(mean + off - most, mean - off - least)};
}

// inverse: of the gradient's products without those of noise.
Eigen::Matrix2d covarianceOf(const PatchRefinement& refined, const Eigen::Matrix2d& inverse) {
  const PatchRefinement::Evidence& evidence = refined.evidence;
  const Eigen::Matrix2d& warp = refined.warp;
  // Share of the residuals that counts as independent; neighbours depend on each other as the images are
  // smoothed. It is one in 5.5 where gradients are the same all over the window, and one in 4 where they
  // change within 3 px.
  constexpr double kIndependent = 0.2;
  const Eigen::Vector2d coupled = inverse * (evidence.gradient * evidence.by_gain);
  // When the other window is smaller, its noise comes from fewer pixels.
  const double independent = kIndependent * 2 / (1 + 1 / std::min(1.0, std::abs(warp.determinant())));
  const Eigen::Matrix2d unit =
      inverse * evidence.gradient * inverse + coupled * coupled.transpose() / evidence.contrast;
  return refined.residual_variance / independent * warp * unit * warp.transpose();
}

}  // namespace

Eigen::Matrix2d PatchRefinement::covariance(double noise_variance) const {
  return covarianceOf(*this, textureOf(*this, noise_variance).inverse);
}

PatchRefinement::Claim PatchRefinement::claim(double noise_variance) const {
  const Texture alone = textureOf(*this, noise_variance);
  const Eigen::Matrix2d there = warp * alone.inverse, back = warp.inverse();
  // The growth contains a part from noise, whose gradient is the same all over the window.
  const double mean_square_distance = (evidence.count - 1) / 12.0;
  const Eigen::Matrix2d growth = evidence.growth - mean_square_distance * alone.noise;
  return {covarianceOf(*this, alone.inverse),
          {there * evidence.moments[0] * back, there * evidence.moments[1] * back},
          there * growth,
          warp * evidence.by_gain};
}

}  // namespace uav_landing
