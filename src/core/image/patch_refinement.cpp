#include "uav_landing/image/patch_refinement.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "image/parabolic_window.h"
#include "image/window_planes.h"

namespace uav_landing {
namespace {

// Shift and gain of: reference + gradient.shift = gain other + offset, by least squares.
struct GainShift {
  bool solved = false;
  Eigen::Vector2d shift;
  double gain = 0;
  double residual = 0;        // sum of squares
  double mean = 0;            // of the other window, less the middle of the reference
  Eigen::Vector2d projected;  // shift that a unit of gain would look like
  double left_over = 0;       // contrast that no shift explains
};

Eigen::Matrix2d aboutMean(const WindowPlanes::MomentSums& sums, const Eigen::Vector2d& gradient_mean) {
  Eigen::Matrix2d moments;
  moments << sums.xx, sums.xy, sums.xy, sums.yy;
  return moments - gradient_mean * Eigen::RowVector2d(sums.x, sums.y);
}

Eigen::Matrix2d aboutMean(const WindowPlanes::GrowthSums& sums, const Eigen::Vector2d& gradient_mean) {
  Eigen::Matrix2d products;
  products << sums.x_across, sums.x_down, sums.y_across, sums.y_down;
  return products - gradient_mean * Eigen::RowVector2d(sums.s_across, sums.s_down);
}

void findOwn(const WindowPlanes& planes, OwnTexture& own) {
  const WindowPlanes::OwnSums sums = planes.sums();
  own.known = true;
  own.mean = sums.a / planes.pixels();
  own.gradient_mean = Eigen::Vector2d(sums.x, sums.y) / planes.pixels();
  const Eigen::Vector2d& mean = own.gradient_mean;
  own.gradient << sums.xx - mean.x() * sums.x, sums.xy - mean.x() * sums.y,  //
      sums.xy - mean.x() * sums.y, sums.yy - mean.y() * sums.y;
  own.right << sums.ax - mean.x() * sums.a, sums.ay - mean.y() * sums.a;
  own.energy = sums.aa - own.mean * sums.a;
  const double determinant = own.gradient.determinant();
  own.usable = determinant > 1e-9 * own.gradient.trace() * own.gradient.trace();
  if (own.usable) own.inverse = own.gradient.inverse();
}

void findDistances(const WindowPlanes& planes, OwnTexture& own) {
  const WindowPlanes::DistanceSums sums = planes.distanceSums();
  own.distances_known = true;
  own.moments = {aboutMean(sums.moments[0], own.gradient_mean),
                 aboutMean(sums.moments[1], own.gradient_mean)};
  own.growth = aboutMean(sums.growth, own.gradient_mean);
}

// A window of the reference.
class ReferenceWindow {
 public:
  ReferenceWindow(const cv::Mat& reference, int u, int v, int radius, OwnTexture& own)
      : planes_(reference, u, v, radius), own_(own) {
    if (!own.known) findOwn(planes_, own);
  }

  bool usable() const { return own_.usable; }
  int count() const { return planes_.pixels(); }
  double energy() const { return own_.energy; }

  // Best shift when the other image is looked at from `at`. The window must be inside by two pixels and
  // paddedReach().
  GainShift compare(const cv::Mat& other, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp) const {
    alignas(32) WindowValues values;
    sampleParabolicWindow(other, at, warp, planes_.radius(), planes_.stride(), values.data());
    return solve(planes_.multiply(values));
  }
  PatchRefinement::Evidence evidence(const GainShift& found) const {
    if (!own_.distances_known) findDistances(planes_, own_);
    return {own_.gradient,
            own_.moments,
            own_.growth,
            found.projected,
            found.gain,
            planes_.middle() + own_.mean,
            planes_.middle() + found.mean,
            found.left_over,
            count()};
  }

  // Places to the right of the centre that are looked at, those filled up included.
  int paddedReach() const { return planes_.stride() - planes_.radius() - 1; }

 private:
  GainShift solve(const WindowPlanes::OtherSums& sums) const {
    GainShift result;
    const Eigen::Vector2d gradient = Eigen::Vector2d(sums.bx, sums.by) - own_.gradient_mean * sums.b;
    const double squares = sums.bb - sums.b * sums.b / count(), reference = sums.ba - own_.mean * sums.b;
    const Eigen::Vector2d projected = own_.inverse * gradient;
    const double left_over = squares - gradient.dot(projected);
    if (!(left_over > 1e-9 * squares)) return result;
    result.gain = (reference - projected.dot(own_.right)) / left_over;
    result.shift = own_.inverse * (own_.right - gradient * result.gain);
    result.residual = std::max(0.0, own_.energy - result.shift.dot(own_.right) - result.gain * reference);
    result.mean = sums.b / count();
    result.projected = projected;
    result.left_over = left_over;
    result.solved = result.gain > 0.1;
    return result;
  }

  WindowPlanes planes_;
  OwnTexture& own_;
};

// Gauss-Newton steps, which all fall short by about the same share: how far one moves the place is seen by
// the next, and each is made longer by that (secant method). Then few are needed, and what the last one
// leaves has no direction of its own.
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
  // The place is good to about 0.005 px, little beside what matches are known to: a single step leaves a
  // tenth of itself, a secant step much less.
  bool converged() const {
    constexpr double kShort = 0.02, kShortSingle = 0.05, kShortSecant = 0.1;
    const double length = wanted_.norm();
    return length < kShortSingle ||
           (count_ > 1 && length < kShortSecant && (made_ - wanted_).norm() < kShort);
  }

 private:
  int count_ = 0;
  // Of the distance, that a step moves; short ones about as much where textures are smoothed alike.
  double share_ = 0.97;
  Eigen::Vector2d wanted_ = Eigen::Vector2d::Zero(), made_ = Eigen::Vector2d::Zero();
};

bool windowInside(const cv::Mat& image, int u, int v, int radius) {
  return u >= radius && v >= radius && u + radius < image.cols && v + radius < image.rows;
}

}  // namespace

// Noise has a gradient, too, but it says nothing: along a line, where there is no other, it would be believed
// to hold the match where it was looked for.
PatchRefinement::Claim PatchRefinement::claim(double noise_variance) const {
  // Variance of the gradient over that of the smoothed noise: (1 - its correlation two pixels on) / 2.
  constexpr double kNoiseGradient = 0.45;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones. One in
  // 5.5 where gradients are the same all over the window, one in 4 where they change within 3 px.
  constexpr double kIndependent = 0.2;
  // Least share of the gradients' energy that can be told from none, given its scatter.
  constexpr double kLeastTexture = 0.1;
  const double of_noise = evidence.count * kNoiseGradient * std::min(noise_variance, 0.5 * residual_variance);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(evidence.gradient);
  const Eigen::Array2d seen = axes.eigenvalues();
  const Eigen::Array2d share = (1 - of_noise / seen).max(kLeastTexture);  // of it that is of the texture
  const Eigen::Matrix2d& V = axes.eigenvectors();
  const Eigen::Matrix2d inverse = V * (1 / (seen * share)).matrix().asDiagonal() * V.transpose();
  const Eigen::Vector2d coupled = inverse * (evidence.gradient * evidence.by_gain);
  // Where the other window is smaller, its noise is that of fewer pixels.
  const double independent = kIndependent * 2 / (1 + 1 / std::min(1.0, std::abs(warp.determinant())));
  const Eigen::Matrix2d unit =
      inverse * evidence.gradient * inverse + coupled * coupled.transpose() / evidence.contrast;
  const Eigen::Matrix2d there = warp * inverse, back = warp.inverse();
  // Noise grows, too: its gradient has this share in it, as it is the same all over the window.
  const double mean_square_distance = (evidence.count - 1) / 12.0;
  const Eigen::Matrix2d noise = V * (seen * (1 - share)).matrix().asDiagonal() * V.transpose();
  const Eigen::Matrix2d growth = evidence.growth - mean_square_distance * noise;
  return {residual_variance / independent * warp * unit * warp.transpose(),
          {there * evidence.moments[0] * back, there * evidence.moments[1] * back},
          there * growth,
          warp * evidence.by_gain};
}

PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius,
                            OwnTexture& own) {
  constexpr int kIterations = 12;
  constexpr double kMaxDrift = 2.0;
  PatchRefinement result;
  if (!windowInside(reference, u, v, radius + 1)) return result;
  const ReferenceWindow window(reference, u, v, radius, own);
  if (!window.usable()) return result;
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
    const GainShift found = window.compare(other, at, warp);
    if (!found.solved) return result;
    at -= warp * steps.next(found.shift);
    if ((at - position).norm() > max_drift) return result;
    if (steps.converged()) {
      result.residual_variance = found.residual / (window.count() - 4);
      result.evidence = window.evidence(found);
      result.warp = warp;
      result.score = std::sqrt(std::max(0.0, 1 - found.residual / std::max(1e-9, window.energy())));
      result.position = at;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
