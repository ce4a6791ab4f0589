#include "uav_landing/patch_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "interpolation.h"

namespace uav_landing {
namespace {

// Values behind each resampled row that may be read but do not count.
constexpr int kPadding = 3;

// Normal equations of: reference + gradient.shift = gain other + offset, for (shift, gain, offset).
struct GainShiftProblem {
  Eigen::Matrix4d information;
  Eigen::Vector4d right;
};

// A window of the reference with its gradient, and all sums of it that do not depend on the other image.
class ReferenceWindow {
 public:
  ReferenceWindow(const cv::Mat& reference, int u, int v, int radius) : radius_(radius) {
    for (int dy = -radius; dy <= radius; ++dy) {
      const float* above = reference.ptr<float>(v + dy - 1) + u;
      const float* row = reference.ptr<float>(v + dy) + u;
      const float* below = reference.ptr<float>(v + dy + 1) + u;
      for (int dx = -radius; dx <= radius; ++dx) {
        const Pixel pixel{row[dx], -0.5f * (row[dx + 1] - row[dx - 1]), -0.5f * (below[dx] - above[dx])};
        pixels_[size_++] = pixel;
        const Eigen::Vector3d x(pixel.gx, pixel.gy, 1);
        fixed_ += x * x.transpose();
        right_ += x * pixel.value;
        squares_ += double(pixel.value) * pixel.value;
      }
    }
  }

  double count() const { return size_; }
  double squares() const { return squares_; }
  double energy() const { return squares_ - right_[2] * right_[2] / size_; }  // about the mean

  // kExact: cubic interpolation of the other image, else linear.
  template <bool kExact>
  GainShiftProblem compare(const cv::Mat& other, const Eigen::Vector2d& at,
                           const Eigen::Matrix2d& warp) const {
    double bx = 0, by = 0, bb = 0, b1 = 0, ba = 0;
    const Pixel* pixel = pixels_.data();
    for (int dy = -radius_; dy <= radius_; ++dy) {
      const double x0 = at.x() + warp(0, 1) * dy, y0 = at.y() + warp(1, 1) * dy;
      for (int dx = -radius_; dx <= radius_; ++dx, ++pixel) {
        const double x = x0 + warp(0, 0) * dx, y = y0 + warp(1, 0) * dx;
        const float b = kExact ? cubicAt(other, x, y) : linearAt(other, x, y);
        bx += b * pixel->gx;
        by += b * pixel->gy;
        bb += b * b;
        b1 += b;
        ba += b * pixel->value;
      }
    }
    GainShiftProblem problem;
    problem.information << fixed_(0, 0), fixed_(0, 1), bx, fixed_(0, 2),  //
        fixed_(1, 0), fixed_(1, 1), by, fixed_(1, 2),                     //
        bx, by, bb, b1,                                                   //
        fixed_(2, 0), fixed_(2, 1), b1, fixed_(2, 2);
    problem.right << right_[0], right_[1], ba, right_[2];
    return problem;
  }

 private:
  struct Pixel {
    float value, gx, gy;
  };
  static constexpr int kLargestRadius = 15;
  std::array<Pixel, (2 * kLargestRadius + 1) * (2 * kLargestRadius + 1)> pixels_;
  int radius_, size_ = 0;
  Eigen::Matrix3d fixed_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  double squares_ = 0;
};

bool windowInside(const cv::Mat& image, int u, int v, int radius) {
  return u >= radius && v >= radius && u + radius < image.cols && v + radius < image.rows;
}

}  // namespace

PatchSearch::PatchSearch(const cv::Mat& reference, const cv::Mat& other, int radius)
    : reference_(reference), other_(other), radius_(radius) {}

bool PatchSearch::sample(const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, int steps) {
  const int reach = radius_ + steps, width = 2 * reach + 1;
  const double rx = std::abs(warp(0, 0)) * reach + std::abs(warp(0, 1)) * reach;
  const double ry = std::abs(warp(1, 0)) * reach + std::abs(warp(1, 1)) * reach;
  if (!(centre.x() - rx >= 0 && centre.y() - ry >= 0 && centre.x() + rx < other_.cols - 1 &&
        centre.y() + ry < other_.rows - 1)) {
    return false;
  }
  area_.assign(static_cast<size_t>(width + kPadding) * width, 0.f);
  for (int j = 0; j < width; ++j) {
    const Eigen::Vector2d start = centre + warp * Eigen::Vector2d(-reach, j - reach);
    float* out = area_.data() + static_cast<size_t>(j) * (width + kPadding);
    for (int i = 0; i < width; ++i) {
      out[i] = linearAt(other_, start.x() + warp(0, 0) * i, start.y() + warp(1, 0) * i);
    }
  }
  return true;
}

void PatchSearch::score(int steps) {
  const int size = 2 * radius_ + 1, count = 2 * steps + 1, width = size + 2 * steps;
  const int padded = (count + kPadding) / 4 * 4;  // no remainder for vector instructions
  scores_.assign(static_cast<size_t>(count) * count, -1.f);
  for (int j = 0; j < count; ++j) {
    cross_.assign(padded, 0.f);
    sums_.assign(width, 0.0);
    squares_.assign(width, 0.0);
    for (int dy = 0; dy < size; ++dy) {
      const float* row = area_.data() + static_cast<size_t>(j + dy) * (width + kPadding);
      for (int i = 0; i < width; ++i) {
        sums_[i] += row[i];
        squares_[i] += double(row[i]) * row[i];
      }
      const float* wanted = template_.values.data() + static_cast<size_t>(dy) * size;
      for (int dx = 0; dx < size; ++dx) {
        const float weight = wanted[dx];
        const float* values = row + dx;
        float* cross = cross_.data();
        for (int i = 0; i < padded; ++i) cross[i] += weight * values[i];
      }
    }
    for (int i = 0; i < count; ++i) {
      double sum = 0, squares = 0;
      for (int dx = 0; dx < size; ++dx) {
        sum += sums_[i + dx];
        squares += squares_[i + dx];
      }
      const double energy = squares - sum * sum / (double(size) * size);
      if (energy < 1e-3 * template_.energy) continue;
      scores_[static_cast<size_t>(j) * count + i] =
          static_cast<float>(cross_[i] / std::sqrt(energy * template_.energy));
    }
  }
}

PatchSearch::Best PatchSearch::run(int u, int v, const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp,
                                   int steps) {
  Best best;
  if (!template_.load(reference_, u, v, radius_) || !sample(centre, warp, steps)) return best;
  score(steps);
  const int count = 2 * steps + 1;
  const int index = static_cast<int>(std::max_element(scores_.begin(), scores_.end()) - scores_.begin());
  const int bi = index % count, bj = index / count;
  best.score = scores_[index];
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      if (std::abs(i - bi) <= 2 && std::abs(j - bj) <= 2) continue;
      best.second = std::max<double>(best.second, scores_[static_cast<size_t>(j) * count + i]);
    }
  }
  best.position = centre + warp * Eigen::Vector2d(bi - steps, bj - steps);
  best.found = bi > 0 && bj > 0 && bi + 1 < count && bj + 1 < count && best.score > 0;
  return best;
}

PatchRefinement refinePatch(const cv::Mat& reference, const cv::Mat& other, int u, int v,
                            const Eigen::Vector2d& position, const Eigen::Matrix2d& warp, int radius) {
  constexpr int kIterations = 10;
  constexpr double kConverged = 0.005, kMaxDrift = 2.0;
  // Shift, in pixels, from which on linear interpolation is no longer good enough.
  constexpr double kNearlyThere = 0.15;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones.
  constexpr double kIndependent = 0.25;
  PatchRefinement result;
  if (!windowInside(reference, u, v, radius + 1)) return result;
  const ReferenceWindow window(reference, u, v, radius);
  const double reach_x = (std::abs(warp(0, 0)) + std::abs(warp(0, 1))) * radius;
  const double reach_y = (std::abs(warp(1, 0)) + std::abs(warp(1, 1))) * radius;
  Eigen::Vector2d at = position;
  bool exact = false;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(at.x() - reach_x >= 1 && at.y() - reach_y >= 1 && at.x() + reach_x < other.cols - 3 &&
          at.y() + reach_y < other.rows - 3)) {
      return result;
    }
    const GainShiftProblem problem =
        exact ? window.compare<true>(other, at, warp) : window.compare<false>(other, at, warp);
    const Eigen::FullPivLU<Eigen::Matrix4d> lu(problem.information);
    if (!lu.isInvertible()) return result;
    const Eigen::Vector4d solution = lu.solve(problem.right);
    if (!(solution[2] > 0.1)) return result;
    Eigen::Vector2d shift = solution.head<2>();
    const double length = shift.norm();
    if (length > 1) shift /= length;
    at -= warp * shift;
    if ((at - position).norm() > kMaxDrift * std::sqrt(std::abs(warp.determinant()))) return result;
    if (exact && length < kConverged) {
      const double residual = std::max(0.0, window.squares() - problem.right.dot(solution));
      const double noise = residual / (window.count() - 4) / kIndependent;
      const Eigen::Matrix4d inverse = lu.inverse();
      result.covariance = noise * warp * inverse.topLeftCorner<2, 2>() * warp.transpose();
      result.score = std::sqrt(std::max(0.0, 1 - residual / std::max(1e-9, window.energy())));
      result.position = at;
      result.converged = true;
      return result;
    }
    exact |= length < kNearlyThere;
  }
  return result;
}

}  // namespace uav_landing
