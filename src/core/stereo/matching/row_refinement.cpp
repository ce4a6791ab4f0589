#include "stereo/matching/row_refinement.h"

#include <algorithm>
#include <cmath>

#include "image/windows/patch_refiner.h"

namespace uav_landing {
namespace {

// Sums over a window about the means: of the window itself, and with a window of the other image. g: change
// of grey along the row, to the right.
struct RowSums {
  double aa, ag, gg, bb, ab, bg;

  RowSums(const OwnTexture& own, const WindowPlanes::OtherSums& other, int count)
      : aa(own.energy),
        ag(-own.right.x()),
        gg(own.gradient(0, 0)),
        bb(other.bb - other.b / count * other.b),
        ab(other.ba - own.mean * other.b),
        bg(-(other.bx - own.gradient_mean.x() * other.b)) {}
};

// Least squares solution of a = gain b + shift g + offset. The shift is in pixels of the reference.
struct RowStep {
  bool solved = false;
  double gain = 0, shift = 0;
  double shift_variance = 0;  // for noise of 1

  explicit RowStep(const RowSums& sums) {
    const double determinant = sums.bb * sums.gg - sums.bg * sums.bg;
    if (!(determinant > 1e-9 * sums.bb * sums.gg)) return;
    gain = (sums.ab * sums.gg - sums.ag * sums.bg) / determinant;
    shift = (sums.ag * sums.bb - sums.ab * sums.bg) / determinant;
    shift_variance = sums.bb / determinant;
    solved = gain > 0.1;
  }
};

// Place of the window when rows may move as well, followed from the place found along the row.
RowRefinement::Across across(const ReferenceWindow& window, const cv::Mat& other,
                             const WindowPlanes::OtherSums& sums, const Eigen::Vector2d& looked_at,
                             const RowWarp& warp) {
  if (!window.usable()) return {};
  const GainShift first = window.solve(sums);
  if (!first.solved) return {};
  return RowRefinement::Across(refineWindow(window, other, {looked_at, warp.matrix()}, &first, false));
}

}  // namespace

RowRefinement::Across::Across(const PatchRefinement& refined) {
  if (!refined.converged) return;
  const Eigen::Matrix2d covariance = refined.covariance();
  found = true;
  place = refined.position;
  column_variance = covariance(0, 0);
  row_variance = covariance(1, 1);
  score = refined.score;
}

RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, const SquareWindow& window,
                             const RowPlace& start, bool across_too) {
  constexpr int kIterations = 8;
  // A step leaves about a tenth of itself, which is little beside the error of a match.
  constexpr double kConverged = 0.05, kMaxDrift = 1.5;
  // The images are smoothed, so neighbouring residuals depend on each other. This share counts as
  // independent.
  constexpr double kIndependent = 0.25;
  RowRefinement result;
  if (!window.isInside(reference, 1)) return result;
  OwnTexture own;
  const ReferenceWindow content(reference, window, own);
  const RowWarp& warp = start.warp;
  if (own.energy <= 0 || own.gradient(0, 0) <= 0) return result;
  const double reach = std::abs(warp.scale) * content.paddedReach() + std::abs(warp.shear) * window.radius;
  double x0 = start.column;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(x0 - reach >= 2 && x0 + reach < other.cols - 3)) return result;
    const WindowPlanes::OtherSums look = content.lookAlongRow(other, window.v, x0, warp.scale, warp.shear);
    const RowSums sums(own, look, content.count());
    const RowStep step(sums);
    if (!step.solved) return result;
    const double looked_at = x0, delta = step.shift * warp.scale;
    x0 += std::clamp(delta, -1.0, 1.0);
    if (std::abs(x0 - start.column) > kMaxDrift) return result;
    if (std::abs(delta) < kConverged) {
      const double residual = std::max(0.0, sums.aa - step.gain * sums.ab - step.shift * sums.ag);
      const double noise = residual / (content.count() - 3) / kIndependent;
      result.stddev = std::abs(warp.scale) * std::sqrt(noise * step.shift_variance);
      result.score = sums.ab / std::sqrt(sums.aa * sums.bb);
      result.position = x0;
      result.converged = true;
      if (across_too) result.across = across(content, other, look, {looked_at, window.v}, warp);
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
