#include "image/windows/patch_matching.h"

#include <algorithm>
#include <cmath>

#include "kernels/lanes/lanes.h"
#include "kernels/window/parabolic_window.h"
#include "kernels/window/window_copy.h"

namespace uav_landing {

PatchSearch::PatchSearch(const cv::Mat& reference, const cv::Mat& other, int radius)
    : reference_(reference), other_(other), radius_(radius) {}

bool PatchSearch::sample(const Eigen::Vector2d& centre, const Eigen::Matrix2d& warp, int steps) {
  const int reach = radius_ + steps, rows = 2 * reach + 1;
  stride_ = (wholeLanes(2 * steps + 1) + 2 * radius_ + 3) / 4 * 4;
  const int padded_reach = stride_ - reach - 1;
  const double rx = std::abs(warp(0, 0)) * padded_reach + std::abs(warp(0, 1)) * reach;
  const double ry = std::abs(warp(1, 0)) * padded_reach + std::abs(warp(1, 1)) * reach;
  if (!(centre.x() - rx >= 2 && centre.y() - ry >= 2 && centre.x() + rx < other_.cols - 3 &&
        centre.y() + ry < other_.rows - 3)) {
    return false;
  }
  area_.resize(wholeLanes(stride_ * rows) + kLanes);
  sampleParabolicWindow(other_, centre, warp, reach, stride_, area_.data());
  // About the mean the values are small, so floats are exact enough for the differences of sums.
  subtract(static_cast<float>(template_.mean), area_.data(), static_cast<int>(area_.size()));
  return true;
}

void PatchSearch::score(int steps) {
  const int count = 2 * steps + 1;
  scores_.resize(static_cast<size_t>(count) * count);
  correlateShifts({template_.values.data(), 2 * radius_ + 1, template_.energy}, area_.data(), stride_, count,
                  rows_, scores_.data());
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

}  // namespace uav_landing
