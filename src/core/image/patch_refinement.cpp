#include "uav_landing/image/patch_refinement.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "image/reference_window.h"

namespace uav_landing {
namespace {

// Gauss-Newton steps. Those of a window fall short by about the same share: how far one moves the place is
// seen by the next, and each is made longer by that (secant method). Then few are needed, and what the last
// one leaves has no direction of its own.
class SecantSteps {
 public:
  // The step to make where Gauss-Newton wants this one.
  Eigen::Vector2d next(const Eigen::Vector2d& wanted) {
    constexpr double kLongest = 1.0, kLeast = 0.4, kMost = 1.5;
    if (made_.squaredNorm() > 0)
      share_ = std::clamp(made_.dot(wanted_ - wanted) / made_.squaredNorm(), kLeast, kMost);
    wanted_ = wanted;
    made_ = wanted / share_;
    made_ /= std::max(1.0, made_.norm() / kLongest);
    ++count_;
    return made_;
  }
  // The place is good to about 0.01 px, little beside what matches are known to: a single step leaves a tenth
  // of itself in the median, up to a third and in any direction, a secant step much less.
  bool converged() const {
    constexpr double kShort = 0.02, kShortSingle = 0.07, kShortSecant = 0.1;
    const double length = wanted_.norm();
    return length < kShortSingle ||
           (count_ > 1 && length < kShortSecant && (made_ - wanted_).norm() < kShort);
  }

 private:
  int count_ = 0;
  // Of the distance, that a step moves; short ones, of many windows, all of it on the average.
  double share_ = 1;
  Eigen::Vector2d wanted_ = Eigen::Vector2d::Zero(), made_ = Eigen::Vector2d::Zero();
};

bool windowInside(const cv::Mat& image, int u, int v, int radius) {
  return u >= radius && v >= radius && u + radius < image.cols && v + radius < image.rows;
}

// The gradient's products without those of noise, inverted, and these.
struct Texture {
  Eigen::Matrix2d inverse, noise;
};

// Noise has a gradient, too, but it says nothing: along a line, where there is no other, it would be believed
// to hold the match where it was looked for.
Texture textureOf(const PatchRefinement& refined, double noise_variance) {
  const PatchRefinement::Evidence& evidence = refined.evidence;
  // Variance of the gradient over that of the smoothed noise: (1 - its correlation two pixels on) / 2.
  constexpr double kNoiseGradient = 0.45;
  // Least share of the gradients' energy that can be told from none, given its scatter.
  constexpr double kLeastTexture = 0.1;
  const double of_noise =
      evidence.count * kNoiseGradient * std::min(noise_variance, 0.5 * refined.residual_variance);
  const auto of_texture = [&](double seen) { return std::max(seen - of_noise, kLeastTexture * seen); };
  const Eigen::Matrix2d& A = evidence.gradient;
  const double mean = 0.5 * A.trace(),
               off = std::sqrt(0.25 * std::pow(A(0, 0) - A(1, 1), 2) + A(1, 0) * A(1, 0));
  const double most = of_texture(mean + off), least = of_texture(mean - off);
  // Any function of a matrix with two eigenvalues is linear in it: no eigenvectors are needed.
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
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones. One in
  // 5.5 where gradients are the same all over the window, one in 4 where they change within 3 px.
  constexpr double kIndependent = 0.2;
  const Eigen::Vector2d coupled = inverse * (evidence.gradient * evidence.by_gain);
  // Where the other window is smaller, its noise is that of fewer pixels.
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
  // Noise grows, too: its gradient has this share in it, as it is the same all over the window.
  const double mean_square_distance = (evidence.count - 1) / 12.0;
  const Eigen::Matrix2d growth = evidence.growth - mean_square_distance * alone.noise;
  return {covarianceOf(*this, alone.inverse),
          {there * evidence.moments[0] * back, there * evidence.moments[1] * back},
          there * growth,
          warp * evidence.by_gain};
}

PatchRefinement refineWindow(const ReferenceWindow& window, const cv::Mat& other,
                             const Eigen::Vector2d& position, const Eigen::Matrix2d& warp,
                             const GainShift* first, bool distances) {
  constexpr int kIterations = 12;
  constexpr double kMaxDrift = 2.0;
  PatchRefinement result;
  const int radius = window.radius();
  const double reach_x = std::abs(warp(0, 0)) * window.paddedReach() + std::abs(warp(0, 1)) * radius;
  const double reach_y = std::abs(warp(1, 0)) * window.paddedReach() + std::abs(warp(1, 1)) * radius;
  const double max_drift = kMaxDrift * std::sqrt(std::abs(warp.determinant()));
  Eigen::Vector2d at = position;
  SecantSteps steps;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(at.x() - reach_x >= 2 && at.y() - reach_y >= 2 && at.x() + reach_x < other.cols - 3 &&
          at.y() + reach_y < other.rows - 3)) {
      return result;
    }
    const GainShift found =
        iteration == 0 && first != nullptr ? *first : window.solve(window.look(other, at, warp));
    if (!found.solved) return result;
    at -= warp * steps.next(found.shift);
    if ((at - position).norm() > max_drift) return result;
    if (steps.converged()) {
      const double energy = window.own().energy;
      result.residual_variance = found.residual / (window.count() - 4);
      result.evidence = window.evidence(found, distances);
      result.warp = warp;
      result.score = std::sqrt(std::max(0.0, 1 - found.residual / std::max(1e-9, energy)));
      result.position = at;
      result.converged = true;
      return result;
    }
  }
  return result;
}

PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius,
                            OwnTexture& own) {
  if (!windowInside(reference, u, v, radius + 1)) return {};
  const ReferenceWindow window(reference, u, v, radius, own);
  if (!window.usable()) return {};
  return refineWindow(window, other, position, warp, nullptr, true);
}

}  // namespace uav_landing
