#include "uav_landing/row_matching.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cubic_window.h"
#include "interpolation.h"

namespace uav_landing {
namespace {

constexpr float kNoScore = -1.f;
constexpr int kBlock = 8;  // positions scored at a time

}  // namespace

RowSearch::RowSearch(const cv::Mat& reference, const cv::Mat& other, int radius, MatchingCost cost)
    : reference_(reference), other_(other), radius_(radius), cost_(cost) {}

bool RowSearch::run(int u, int v, double centre, int steps, const RowWarp& warp) {
  scores_.clear();
  if (!template_.load(reference_, u, v, radius_)) return false;
  const int size = 2 * radius_ + 1, width = size + 2 * steps;
  steps_ = steps;
  centre_ = centre;
  scale_ = warp.scale;
  padded_ = (2 * steps + kBlock) / kBlock * kBlock;
  stride_ = padded_ + size;
  strip_.resize(static_cast<size_t>(stride_) * size);
  for (int dy = 0; dy < size; ++dy) {
    const double start = centre + warp.shear * (dy - radius_) - warp.scale * (radius_ + steps);
    resample(other_.ptr<float>(v - radius_ + dy), start, width,
             strip_.data() + static_cast<size_t>(dy) * stride_);
  }
  scoreAll();
  return true;
}

void RowSearch::resample(const float* row, double start, int width, float* out) const {
  const float mean = static_cast<float>(template_.mean);
  const double end = start + scale_ * (width - 1);
  if (start >= 0 && end < other_.cols - 1.01) {
    std::int32_t x = CubicTable::fixed(start);
    const std::int32_t step = CubicTable::fixed(scale_);
    for (int i = 0; i < width; ++i, x += step) {
      const float* p = row + (x >> CubicTable::kFixedBits);
      const float t =
          static_cast<float>(x & CubicTable::kFractionMask) * (1.f / (1 << CubicTable::kFixedBits));
      out[i] = p[0] + t * (p[1] - p[0]) - mean;
    }
  } else {
    for (int i = 0; i < width; ++i) {
      const double x = start + scale_ * i;
      out[i] = x >= 0 && x < other_.cols - 1 ? linearAt(row, static_cast<float>(x)) - mean
                                             : std::numeric_limits<float>::quiet_NaN();
    }
  }
  std::fill(out + width, out + stride_, 0.f);
}

// Positions are worked on in blocks that fit into registers: cross products with the template, and sum and
// squares of what is under it.
void RowSearch::scoreAll() {
  using cv::v_float32x4;
  const int size = 2 * radius_ + 1, count = 2 * steps_ + 1;
  column_sums_.assign(stride_, 0.f);
  column_squares_.assign(stride_, 0.f);
  for (int dy = 0; dy < size; ++dy) {
    const float* row = strip_.data() + static_cast<size_t>(dy) * stride_;
    for (int i = 0; i < stride_; ++i) {
      column_sums_[i] += row[i];
      column_squares_[i] += row[i] * row[i];
    }
  }
  scores_.resize(padded_);
  for (int first = 0; first < padded_; first += kBlock) {
    v_float32x4 cross[2] = {cv::v_setzero_f32(), cv::v_setzero_f32()};
    v_float32x4 sums[2] = {cross[0], cross[0]}, squares[2] = {cross[0], cross[0]};
    const float* wanted = template_.values.data();
    for (int dy = 0; dy < size; ++dy) {
      const float* row = strip_.data() + static_cast<size_t>(dy) * stride_ + first;
      for (int dx = 0; dx < size; ++dx) {
        const v_float32x4 weight = cv::v_setall_f32(*wanted++);
        cross[0] = cv::v_muladd(weight, cv::v_load(row + dx), cross[0]);
        cross[1] = cv::v_muladd(weight, cv::v_load(row + dx + 4), cross[1]);
      }
    }
    for (int dx = 0; dx < size; ++dx)
      for (int k = 0; k < 2; ++k) {
        sums[k] = sums[k] + cv::v_load(column_sums_.data() + first + dx + 4 * k);
        squares[k] = squares[k] + cv::v_load(column_squares_.data() + first + dx + 4 * k);
      }
    float values[3][kBlock];
    for (int k = 0; k < 2; ++k) {
      cv::v_store(values[0] + 4 * k, cross[k]);
      cv::v_store(values[1] + 4 * k, sums[k]);
      cv::v_store(values[2] + 4 * k, squares[k]);
    }
    for (int k = 0; k < kBlock; ++k)
      scores_[first + k] = static_cast<float>(similarity(values[0][k], values[1][k], values[2][k]));
  }
  scores_.resize(count);
}

double RowSearch::similarity(double cross, double sum, double squares) const {
  if (std::isnan(sum)) return kNoScore;
  if (cost_ == MatchingCost::kSsd) {
    // Sum of squared differences over twice the template's own energy: 1 when equal, 0 when unrelated.
    return 1.0 - (template_.energy - 2.0 * cross + squares) / (2.0 * template_.energy);
  }
  const double energy = squares - sum * sum / static_cast<double>(template_.values.size());
  if (energy < 1e-3 * template_.energy) return kNoScore;
  return cross / std::sqrt(energy * template_.energy);
}

RowCandidate RowSearch::interpolated(int index) const {
  double offset = 0;
  const double s = scores_[index];
  if (index > 0 && index + 1 < static_cast<int>(scores_.size())) {
    const double before = scores_[index - 1], after = scores_[index + 1];
    const double curvature = before - 2 * s + after;
    if (before > kNoScore && after > kNoScore && curvature < 0) offset = 0.5 * (before - after) / curvature;
  }
  return {centre_ + scale_ * (index - steps_ + offset), s};
}

RowCandidate RowSearch::best(double* second_score) const {
  const auto peak = std::max_element(scores_.begin(), scores_.end());
  if (peak == scores_.end()) return {0, kNoScore};
  const int index = static_cast<int>(peak - scores_.begin());
  if (second_score) {
    *second_score = kNoScore;
    for (int k = 1; k + 1 < static_cast<int>(scores_.size()); ++k) {
      if (std::abs(k - index) > 2 && scores_[k] >= scores_[k - 1] && scores_[k] >= scores_[k + 1]) {
        *second_score = std::max<double>(*second_score, scores_[k]);
      }
    }
  }
  return interpolated(index);
}

std::vector<RowCandidate> RowSearch::peaks(double min_score, int count) const {
  std::vector<RowCandidate> found;
  for (int k = 0; k < static_cast<int>(scores_.size()); ++k) {
    const bool rises = k == 0 || scores_[k] > scores_[k - 1];
    const bool falls = k + 1 == static_cast<int>(scores_.size()) || scores_[k] >= scores_[k + 1];
    if (scores_[k] >= min_score && rises && falls) found.push_back(interpolated(k));
  }
  std::sort(found.begin(), found.end(),
            [](const RowCandidate& a, const RowCandidate& b) { return a.score > b.score; });
  if (found.size() > static_cast<size_t>(count)) found.resize(count);
  return found;
}

namespace {

// A window of the reference and its change along the row, about their means, in rows filled up with zeros to
// a multiple of four; with the sums that do not depend on the other image.
struct RowWindow {
  static constexpr int kLargestRadius = 15, kLargestStride = 32;

  int size, stride;
  double aa = 0, ag = 0, gg = 0;  // reference and gradient with themselves and each other
  float mean = 0;
  std::array<float, kLargestStride*(2 * kLargestRadius + 1)> value, gradient;

  RowWindow(const cv::Mat& image, int u, int v, int radius)
      : size(2 * radius + 1), stride((size + 3) / 4 * 4) {
    float sum = 0, gradient_sum = 0;
    for (int j = 0; j < size; ++j) {
      const float* row = image.ptr<float>(v - radius + j) + u - radius;
      float *a = &value[j * stride], *g = &gradient[j * stride];
      for (int i = 0; i < size; ++i) {
        a[i] = row[i];
        g[i] = 0.5f * (row[i + 1] - row[i - 1]);
        sum += a[i];
        gradient_sum += g[i];
      }
    }
    mean = sum / count();
    const float gradient_mean = gradient_sum / count();
    float sums[3] = {0, 0, 0};
    for (int j = 0; j < size; ++j) {
      float *a = &value[j * stride], *g = &gradient[j * stride];
      std::fill(a + size, a + stride, 0.f);
      std::fill(g + size, g + stride, 0.f);
      for (int i = 0; i < size; ++i) {
        a[i] -= mean;
        g[i] -= gradient_mean;
        sums[0] += a[i] * a[i];
        sums[1] += a[i] * g[i];
        sums[2] += g[i] * g[i];
      }
    }
    aa = sums[0];
    ag = sums[1];
    gg = sums[2];
  }
  int count() const { return size * size; }
};

// Sums over a window of the other image: about its mean with itself, with the reference and its gradient.
struct RowSums {
  double bb, ab, bg;
};

RowSums compareAlongRow(const RowWindow& window, const cv::Mat& other, int v, double position,
                        const RowWarp& warp) {
  using cv::v_float32x4;
  const int radius = window.size / 2;
  alignas(16) float row[RowWindow::kLargestStride], inside[RowWindow::kLargestStride];
  for (int i = 0; i < window.stride; ++i) inside[i] = i < window.size ? 1.f : 0.f;
  const v_float32x4 mean = cv::v_setall_f32(window.mean);
  v_float32x4 b1 = cv::v_setzero_f32(), bb = b1, ab = b1, bg = b1;
  const float *a = window.value.data(), *g = window.gradient.data();
  const std::int32_t step = CubicTable::fixed(warp.scale);
  for (int dy = -radius; dy <= radius; ++dy) {
    const double start = position + warp.shear * dy - warp.scale * radius;
    sampleCubicRow(other.ptr<float>(v + dy), CubicTable::fixed(start), step, window.stride, row);
    for (int i = 0; i < window.stride; i += 4, a += 4, g += 4) {
      const v_float32x4 b = (cv::v_load_aligned(row + i) - mean) * cv::v_load_aligned(inside + i);
      b1 = b1 + b;
      bb = cv::v_muladd(b, b, bb);
      ab = cv::v_muladd(b, cv::v_load(a), ab);
      bg = cv::v_muladd(b, cv::v_load(g), bg);
    }
  }
  const double sum = cv::v_reduce_sum(b1);
  return {cv::v_reduce_sum(bb) - sum * sum / window.count(), cv::v_reduce_sum(ab), cv::v_reduce_sum(bg)};
}

}  // namespace

RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, int u, int v, double position,
                             const RowWarp& warp, int radius) {
  constexpr int kIterations = 8;
  // A step leaves about a tenth of itself.
  constexpr double kConverged = 0.02, kMaxDrift = 1.5;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones.
  constexpr double kIndependent = 0.25;
  RowRefinement result;
  if (u < radius + 1 || v < radius || u + radius + 1 >= reference.cols || v + radius >= reference.rows)
    return result;
  const RowWindow window(reference, u, v, radius);
  if (window.aa <= 0 || window.gg <= 0) return result;
  const int padded = window.stride - radius - 1;
  const double reach = std::abs(warp.scale) * padded + std::abs(warp.shear) * radius;
  double x0 = position;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!(x0 - reach >= 2 && x0 + reach < other.cols - 3)) return result;
    const RowSums sums = compareAlongRow(window, other, v, x0, warp);
    // a = gain b + shift g + offset, by least squares for gain and shift (pixels of the reference).
    const double determinant = sums.bb * window.gg - sums.bg * sums.bg;
    if (!(determinant > 1e-9 * sums.bb * window.gg)) return result;
    const double gain = (sums.ab * window.gg - window.ag * sums.bg) / determinant;
    const double shift = (window.ag * sums.bb - sums.ab * sums.bg) / determinant;
    if (!(gain > 0.1)) return result;
    const double delta = shift * warp.scale;
    x0 += std::clamp(delta, -1.0, 1.0);
    if (std::abs(x0 - position) > kMaxDrift) return result;
    if (std::abs(delta) < kConverged) {
      const double residual = std::max(0.0, window.aa - gain * sums.ab - shift * window.ag);
      const double noise = residual / (window.count() - 3) / kIndependent;
      result.stddev = std::abs(warp.scale) * std::sqrt(noise * sums.bb / determinant);
      result.score = sums.ab / std::sqrt(window.aa * sums.bb);
      result.position = x0;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
