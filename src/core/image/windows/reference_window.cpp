#include "image/windows/reference_window.h"

#include <Eigen/LU>
#include <algorithm>

#include "kernels/window/parabolic_window.h"

namespace uav_landing {
namespace {

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

}  // namespace

ReferenceWindow::ReferenceWindow(const cv::Mat& reference, const SquareWindow& window, OwnTexture& own)
    : planes_(reference, window.u, window.v, window.radius), own_(own) {
  if (!own.known) findOwn(planes_, own);
}

WindowPlanes::OtherSums ReferenceWindow::look(const cv::Mat& other, const Eigen::Vector2d& at,
                                              const Eigen::Matrix2d& warp) const {
  alignas(32) WindowValues values;
  sampleParabolicWindow(other, at, warp, planes_.radius(), planes_.stride(), values.data());
  return planes_.multiply(values);
}

WindowPlanes::OtherSums ReferenceWindow::lookAlongRow(const cv::Mat& other, int v, double place, double scale,
                                                      double shear) const {
  alignas(32) WindowValues values;
  const int radius = planes_.radius();
  sampleParabolicRows(other, v - radius, place - shear * radius - scale * radius, shear, scale,
                      planes_.size(), planes_.stride(), values.data());
  return planes_.multiply(values);
}

GainShift ReferenceWindow::solve(const WindowPlanes::OtherSums& sums) const {
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

PatchRefinement::Evidence ReferenceWindow::evidence(const GainShift& found, bool distances) const {
  if (distances && !own_.distances_known) findDistances(planes_, own_);
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

}  // namespace uav_landing
