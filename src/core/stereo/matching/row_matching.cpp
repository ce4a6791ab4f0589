#include "stereo/matching/row_matching.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes/lanes.h"
#include "kernels/window/strip.h"

namespace uav_landing {

RowSearch::RowSearch(const cv::Mat& reference, const cv::Mat& other, int radius, MatchingCost cost)
    : reference_(reference), other_(other), radius_(radius), cost_(cost) {}

bool RowSearch::run(int u, int v, double centre, int steps, const RowWarp& warp) {
  scores_.clear();
  if (!template_.load(reference_, u, v, radius_)) return false;
  const int size = 2 * radius_ + 1, count = 2 * steps + 1;
  steps_ = steps;
  centre_ = centre;
  scale_ = warp.scale;
  // Positions are scored in whole blocks; scores beyond the last position mean nothing.
  const int padded = wholeLanes(count), stride = wholeLanes(padded + size - 1);
  strip_.resize(static_cast<size_t>(stride) * size);
  sampleStrip(other_, v - radius_,
              {centre_ - warp.shear * radius_ - scale_ * (radius_ + steps), warp.shear, scale_},
              {size, size + 2 * steps, stride}, static_cast<float>(template_.mean), strip_.data());
  scores_.resize(padded);
  const auto score = cost_ == MatchingCost::kSsd ? compareAlong : correlateAlong;
  score({template_.values.data(), size, template_.energy}, strip_.data(), stride, padded, columns_,
        scores_.data());
  scores_.resize(count);
  return true;
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

}  // namespace uav_landing
