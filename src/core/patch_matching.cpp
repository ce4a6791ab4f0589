#include "uav_landing/patch_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "cubic_window.h"
#include "interpolation.h"

namespace uav_landing {
namespace {

// Values behind each resampled row that may be read but do not count.
constexpr int kPadding = 3;

// Sums over a window of the other image with the reference's value and gradient, all about their means.
struct WindowSums {
  Eigen::Vector2d gradient;   // other times gradient
  double squares, reference;  // other times itself, times the reference
};

// Shift and gain of: reference + gradient.shift = gain other + offset, by least squares.
struct GainShift {
  bool solved = false;
  Eigen::Vector2d shift;
  double gain = 0;
  double residual = 0;              // sum of squares
  Eigen::Matrix2d unit_covariance;  // of the shift, for residuals of variance 1
};

// A window of the reference with its gradient about their means, and all sums of it that do not depend on the
// other image. Rows are filled up to a multiple of four with zeros.
class ReferenceWindow {
 public:
  ReferenceWindow(const cv::Mat& reference, int u, int v, int radius)
      : radius_(radius), size_(2 * radius + 1), stride_((size_ + 3) / 4 * 4) {
    float* out = values_.data();
    float sums[3] = {0, 0, 0};
    for (int dy = -radius; dy <= radius; ++dy, out += stride_) {
      const float* above = reference.ptr<float>(v + dy - 1) + u - radius;
      const float* row = reference.ptr<float>(v + dy) + u - radius;
      const float* below = reference.ptr<float>(v + dy + 1) + u - radius;
      float *gx = out + kPlane, *gy = gx + kPlane;
      for (int i = 0; i < size_; ++i) {
        out[i] = row[i];
        gx[i] = -0.5f * (row[i + 1] - row[i - 1]);
        gy[i] = -0.5f * (below[i] - above[i]);
        sums[0] += out[i];
        sums[1] += gx[i];
        sums[2] += gy[i];
      }
    }
    for (int k = 0; k < 3; ++k) subtract(values_.data() + k * kPlane, means_[k] = sums[k] / count());
    const float *a = values_.data(), *gx = a + kPlane, *gy = gx + kPlane;
    G_ << product(gx, gx), product(gx, gy), product(gx, gy), product(gy, gy);
    right_ << product(gx, a), product(gy, a);
    energy_ = product(a, a);
    const double determinant = G_.determinant();
    usable_ = determinant > 1e-9 * G_.trace() * G_.trace();
    if (usable_) inverse_ = G_.inverse();
  }

  bool usable() const { return usable_; }
  int count() const { return size_ * size_; }
  double energy() const { return energy_; }

  // Best shift when the other image is looked at from `at`. The window must be inside by two pixels and
  // paddedReach().
  GainShift compare(const cv::Mat& other, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp) const {
    return solve(sums(other, at, warp));
  }
  // Places to the right of the centre that are looked at, those filled up included.
  int paddedReach() const { return stride_ - radius_ - 1; }

 private:
  static constexpr int kLargestRadius = 15, kLargestStride = 32;
  static constexpr int kPlane = kLargestStride * (2 * kLargestRadius + 1);

  void subtract(float* values, float mean) const {
    for (int j = 0; j < size_; ++j, values += stride_) {
      for (int i = 0; i < size_; ++i) values[i] -= mean;
      for (int i = size_; i < stride_; ++i) values[i] = 0;
    }
  }

  double product(const float* a, const float* b) const {
    cv::v_float32x4 sum = cv::v_setzero_f32();
    for (int i = 0; i < size_ * stride_; i += 4)
      sum = cv::v_muladd(cv::v_load(a + i), cv::v_load(b + i), sum);
    return cv::v_reduce_sum(sum);
  }

  WindowSums sums(const cv::Mat& other, const Eigen::Vector2d& at, const Eigen::Matrix2d& warp) const {
    using cv::v_float32x4;
    alignas(16) float row[kLargestStride];
    alignas(16) float counts[kLargestStride];
    for (int i = 0; i < stride_; ++i) counts[i] = i < size_ ? 1.f : 0.f;
    const v_float32x4 mean = cv::v_setall_f32(means_[0]);
    v_float32x4 bx = cv::v_setzero_f32(), by = bx, bb = bx, b1 = bx, ba = bx;
    const float* a = values_.data();
    const std::int32_t step_x = CubicTable::fixed(warp(0, 0)), step_y = CubicTable::fixed(warp(1, 0));
    for (int dy = -radius_; dy <= radius_; ++dy) {
      const Eigen::Vector2d start = at + warp * Eigen::Vector2d(-radius_, dy);
      sampleCubicLine(other, CubicTable::fixed(start.x()), CubicTable::fixed(start.y()), step_x, step_y,
                      stride_, row);
      for (int i = 0; i < stride_; i += 4, a += 4) {
        const v_float32x4 b = (cv::v_load_aligned(row + i) - mean) * cv::v_load_aligned(counts + i);
        bx = cv::v_muladd(b, cv::v_load(a + kPlane), bx);
        by = cv::v_muladd(b, cv::v_load(a + 2 * kPlane), by);
        bb = cv::v_muladd(b, b, bb);
        b1 = b1 + b;
        ba = cv::v_muladd(b, cv::v_load(a), ba);
      }
    }
    // Reference and gradient have no mean, so that of the other image matters to its own square only.
    const double sum = cv::v_reduce_sum(b1);
    return {{cv::v_reduce_sum(bx), cv::v_reduce_sum(by)},
            cv::v_reduce_sum(bb) - sum * sum / count(),
            cv::v_reduce_sum(ba)};
  }

  GainShift solve(const WindowSums& sums) const {
    GainShift result;
    const Eigen::Vector2d projected = inverse_ * sums.gradient;
    const double left_over = sums.squares - sums.gradient.dot(projected);
    if (!(left_over > 1e-9 * sums.squares)) return result;
    result.gain = (sums.reference - projected.dot(right_)) / left_over;
    result.shift = inverse_ * (right_ - sums.gradient * result.gain);
    result.residual = std::max(0.0, energy_ - result.shift.dot(right_) - result.gain * sums.reference);
    result.unit_covariance = inverse_ + projected * projected.transpose() / left_over;
    result.solved = result.gain > 0.1;
    return result;
  }

  int radius_, size_, stride_;
  bool usable_ = false;
  alignas(16) std::array<float, 3 * kPlane> values_;  // reference, gradient along u, along v
  float means_[3];
  Eigen::Matrix2d G_, inverse_;
  Eigen::Vector2d right_;
  double energy_ = 0;
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
  constexpr int kIterations = 12;
  // A step leaves about a tenth of itself, so after one this long the place is good to less than 0.001 px.
  constexpr double kConverged = 0.004, kMaxDrift = 2.0;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones.
  constexpr double kIndependent = 0.25;
  PatchRefinement result;
  if (!windowInside(reference, u, v, radius + 1)) return result;
  const ReferenceWindow window(reference, u, v, radius);
  if (!window.usable()) return result;
  const double reach_x = std::abs(warp(0, 0)) * window.paddedReach() + std::abs(warp(0, 1)) * radius;
  const double reach_y = std::abs(warp(1, 0)) * window.paddedReach() + std::abs(warp(1, 1)) * radius;
  const double max_drift = kMaxDrift * std::sqrt(std::abs(warp.determinant()));
  Eigen::Vector2d at = position;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(at.x() - reach_x >= 2 && at.y() - reach_y >= 2 && at.x() + reach_x < other.cols - 3 &&
          at.y() + reach_y < other.rows - 3)) {
      return result;
    }
    const GainShift found = window.compare(other, at, warp);
    if (!found.solved) return result;
    const double length = found.shift.norm();
    at -= warp * found.shift / std::max(1.0, length);
    if ((at - position).norm() > max_drift) return result;
    if (length < kConverged) {
      const double noise = found.residual / (window.count() - 4) / kIndependent;
      result.covariance = noise * warp * found.unit_covariance * warp.transpose();
      result.score = std::sqrt(std::max(0.0, 1 - found.residual / std::max(1e-9, window.energy())));
      result.position = at;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
