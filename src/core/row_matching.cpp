#include "uav_landing/row_matching.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "interpolation.h"

namespace uav_landing {
namespace {

constexpr float kNoScore = -1.f;
constexpr int kPadding = 3;  // values behind each resampled row that may be read but do not count

}  // namespace

RowSearch::RowSearch(const cv::Mat& reference, const cv::Mat& other, int radius, MatchingCost cost)
    : reference_(reference), other_(other), radius_(radius), cost_(cost) {}

bool RowSearch::run(int u, int v, double centre, int steps, const RowWarp& warp) {
  scores_.clear();
  if (!template_.load(reference_, u, v, radius_)) return false;
  const int size = 2 * radius_ + 1, width = size + 2 * steps, stride = width + kPadding;
  steps_ = steps;
  centre_ = centre;
  scale_ = warp.scale;
  strip_.assign(static_cast<size_t>(stride) * size, 0.f);
  for (int dy = 0; dy < size; ++dy) {
    const float* row = other_.ptr<float>(v - radius_ + dy);
    const double start = centre + warp.shear * (dy - radius_) - warp.scale * (radius_ + steps);
    float* out = strip_.data() + static_cast<size_t>(dy) * stride;
    for (int i = 0; i < width; ++i) {
      const double x = start + warp.scale * i;
      out[i] = x >= 0 && x < other_.cols - 1 ? linearAt(row, static_cast<float>(x))
                                             : std::numeric_limits<float>::quiet_NaN();
    }
  }
  scoreAll();
  return true;
}

// The sums run over the positions k in the inner loop, which compilers turn into vector instructions; a
// multiple of four of them, so that no remainder is left over.
void RowSearch::scoreAll() {
  const int size = 2 * radius_ + 1, count = 2 * steps_ + 1, width = size + 2 * steps_;
  const int padded = (count + kPadding) / 4 * 4;
  const float mean = static_cast<float>(template_.mean);
  cross_.assign(padded, 0.f);
  column_sums_.assign(width, 0.f);
  column_squares_.assign(width, 0.f);
  for (int dy = 0; dy < size; ++dy) {
    float* row = strip_.data() + static_cast<size_t>(dy) * (width + kPadding);
    for (int i = 0; i < width; ++i) {
      row[i] -= mean;
      column_sums_[i] += row[i];
      column_squares_[i] += row[i] * row[i];
    }
    const float* wanted = template_.values.data() + static_cast<size_t>(dy) * size;
    for (int dx = 0; dx < size; ++dx) {
      const float weight = wanted[dx];
      const float* values = row + dx;
      float* cross = cross_.data();
      for (int k = 0; k < padded; ++k) cross[k] += weight * values[k];
    }
  }
  scores_.resize(count);
  for (int k = 0; k < count; ++k) {
    double sum = 0, squares = 0;
    for (int dx = 0; dx < size; ++dx) {
      sum += column_sums_[k + dx];
      squares += column_squares_[k + dx];
    }
    scores_[k] = static_cast<float>(similarity(cross_[k], sum, squares));
  }
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

RowRefinement refineAlongRow(const cv::Mat& reference, const cv::Mat& other, int u, int v, double position,
                             const RowWarp& warp, int radius) {
  constexpr int kIterations = 8;
  constexpr double kConverged = 0.003, kMaxDrift = 1.5;
  // The images are smoothed, so neighbouring residuals are not independent; share of independent ones.
  constexpr double kIndependent = 0.25;
  RowRefinement result;
  if (u < radius || v < radius || u + radius >= reference.cols || v + radius >= reference.rows) return result;
  const double count = (2.0 * radius + 1) * (2.0 * radius + 1);
  double x0 = position;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double reach = std::abs(warp.scale) * radius + std::abs(warp.shear) * radius;
    if (!(x0 - reach >= 1 && x0 + reach < other.cols - 2)) return result;
    // Sums for the centred problem: a = reference, b = other, g = its derivative.
    double sa = 0, sb = 0, sg = 0, saa = 0, sbb = 0, sgg = 0, sab = 0, sag = 0, sbg = 0;
    for (int dy = -radius; dy <= radius; ++dy) {
      const float* wanted = reference.ptr<float>(v + dy) + u;
      const float* row = other.ptr<float>(v + dy);
      for (int dx = -radius; dx <= radius; ++dx) {
        float derivative;
        const float b = cubicAt(row, static_cast<float>(x0 + warp.scale * dx + warp.shear * dy), &derivative);
        const float a = wanted[dx];
        sa += a;
        sb += b;
        sg += derivative;
        saa += a * a;
        sbb += b * b;
        sgg += derivative * derivative;
        sab += a * b;
        sag += a * derivative;
        sbg += b * derivative;
      }
    }
    const double caa = saa - sa * sa / count, cbb = sbb - sb * sb / count, cgg = sgg - sg * sg / count;
    const double cab = sab - sa * sb / count, cag = sag - sa * sg / count, cbg = sbg - sb * sg / count;
    if (cbb <= 0 || caa <= 0) return result;
    // a = (gain) b + (gain delta) g + offset: least squares for gain and gain delta.
    const double determinant = cbb * cgg - cbg * cbg;
    if (determinant <= 1e-9 * cbb * cgg) return result;
    const double gain = (cab * cgg - cag * cbg) / determinant;
    const double shifted = (cag * cbb - cab * cbg) / determinant;
    if (!(gain > 0.1)) return result;
    const double delta = shifted / gain;
    x0 += std::clamp(delta, -1.0, 1.0);
    if (std::abs(x0 - position) > kMaxDrift) return result;
    if (std::abs(delta) < kConverged) {
      const double residual = std::max(0.0, caa - gain * cab - shifted * cag);
      const double noise = residual / (count - 3) / kIndependent;
      result.stddev = std::sqrt(noise * cbb / determinant) / gain;
      result.score = cab / std::sqrt(caa * cbb);
      result.position = x0;
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace uav_landing
