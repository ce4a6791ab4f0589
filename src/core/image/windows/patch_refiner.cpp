#include "image/windows/patch_refiner.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Gauss-Newton steps made longer by the secant method. All steps of a window fall short by about the same
// share. The next step shows how far the last one moved the place, and corrects for the rest. So few steps
// are needed, and the remaining error has no preferred direction.
class SecantSteps {
 public:
  // The step to make when Gauss-Newton proposes this one.
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
  // The place is then good to about 0.01 px, which is little beside the error of a match. A single step
  // leaves a tenth of itself in the median and up to a third, in any direction. A secant step leaves much
  // less.
  bool converged() const {
    constexpr double kShort = 0.02, kShortSingle = 0.07, kShortSecant = 0.1;
    const double length = wanted_.norm();
    return length < kShortSingle ||
           (count_ > 1 && length < kShortSecant && (made_ - wanted_).norm() < kShort);
  }

 private:
  int count_ = 0;
  // Share of the distance that a step moves. Short steps, over many windows, move all of it on average.
  double share_ = 1;
  Eigen::Vector2d wanted_ = Eigen::Vector2d::Zero(), made_ = Eigen::Vector2d::Zero();
};

}  // namespace

PatchRefinement refineWindow(const ReferenceWindow& window, const cv::Mat& other, const WindowPlace& start,
                             const GainShift* first, bool distances) {
  constexpr int kIterations = 12;
  constexpr double kMaxDrift = 2.0;
  PatchRefinement result;
  const auto& [position, warp] = start;
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

PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, const SquareWindow& window,
                            const WindowPlace& start, OwnTexture& own) {
  if (!window.isInside(reference, 1)) return {};
  const ReferenceWindow content(reference, window, own);
  if (!content.usable()) return {};
  return refineWindow(content, other, start, nullptr, true);
}

}  // namespace uav_landing
