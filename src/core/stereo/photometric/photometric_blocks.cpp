#include "stereo/photometric/photometric_blocks.h"

#include <algorithm>
#include <cmath>

#include "estimation/robust.h"

namespace uav_landing {
namespace {

// Ground with a smaller disparity (pixels) is too near the horizon to tell the height.
constexpr double kLeastDisparity = 0.3;
// A block with a smaller sum of squared grey levels shows nothing.
constexpr float kLeastEnergy = 0.25f * PhotometricBlocks::kPixels;

}  // namespace

PhotometricBlocks::PhotometricBlocks(cv::Mat left_mask, cv::Mat right_mask)
    : left_mask_(std::move(left_mask)), right_mask_(std::move(right_mask)) {}

bool PhotometricBlocks::usable(const StereoRig& rig, const ShiftModel& shift, int u, int v) const {
  for (const int y : {v, v + kHeight - 1}) {
    for (const int x : {u, u + kWidth / 2, u + kWidth - 1}) {  // a strut may be narrower than a block
      const double moved = shift.at(x, y), column = x - moved;
      if (!(moved - rig.principalOffset() >= kLeastDisparity)) return false;
      if (!(column >= kMargin && column <= right_mask_.cols - 2 - kMargin)) return false;
      if (left_mask_.at<uchar>(y, x) == 0 || right_mask_.at<uchar>(y, cvRound(column)) == 0) return false;
    }
  }
  return true;
}

void PhotometricBlocks::findCandidates(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift) {
  candidates_.clear();
  // The highest row that may be ground, at the left or right edge.
  const double limit = kLeastDisparity + rig.principalOffset();
  const auto horizon = [&](double u) { return (limit - shift.c - shift.a * u) / shift.b; };
  const double highest = shift.b > 0 ? std::min(horizon(0), horizon(left.cols - 1)) : 0;
  first_row_ = static_cast<int>(std::clamp<double>(std::ceil(highest), kMargin, left.rows - 1));
  if (left.rows - first_row_ < kHeight + kMargin) return;
  const auto stride = static_cast<std::ptrdiff_t>(left.step);
  for (int v = first_row_; v + kHeight + kMargin <= left.rows; v += kHeight) {
    for (int u = kMargin; u + kWidth + kMargin <= left.cols; u += kWidth) {
      if (!usable(rig, shift, u, v)) continue;
      candidates_.push_back({u, v, slopeEnergy(left.ptr<uchar>(v) + u, stride), false});
    }
  }
}

double PhotometricBlocks::usualEnergy() const {
  if (candidates_.empty()) return 0;
  std::vector<double> energies;
  energies.reserve(candidates_.size());
  for (const Candidate& candidate : candidates_) energies.push_back(candidate.energy);
  return medianOf(energies) / (kSobelScale * kSobelScale);
}

// First the strongest block in each cell of a coarse grid, so that every part of the ground takes part; then
// the strongest of all.
void PhotometricBlocks::pick(int count) {
  constexpr int kCell = 4;  // blocks along each side of a cell
  if (static_cast<int>(candidates_.size()) <= count) {
    for (Candidate& candidate : candidates_) candidate.chosen = true;
    return;
  }
  const int columns = left_mask_.cols / (kCell * kWidth) + 1, rows = left_mask_.rows / (kCell * kHeight) + 1;
  std::vector<Candidate*> strongest(static_cast<size_t>(columns) * rows, nullptr), order;
  for (Candidate& candidate : candidates_) {
    const size_t cell = static_cast<size_t>((candidate.v - first_row_) / (kCell * kHeight)) * columns +
                        candidate.u / (kCell * kWidth);
    if (strongest[cell] == nullptr || strongest[cell]->energy < candidate.energy)
      strongest[cell] = &candidate;
    order.push_back(&candidate);
  }
  for (Candidate* candidate : strongest) {
    if (candidate == nullptr) continue;
    candidate->chosen = true;
    --count;
  }
  const auto stronger = [](const Candidate* a, const Candidate* b) { return a->energy > b->energy; };
  const auto end = order.begin() + std::clamp<int>(count, 0, static_cast<int>(order.size()));
  std::nth_element(order.begin(), end, order.end(), stronger);
  std::for_each(order.begin(), end, [](Candidate* candidate) { candidate->chosen = true; });
}

bool PhotometricBlocks::makeBlock(const cv::Mat& left, const Candidate& candidate, Block& block) {
  block.u = candidate.u;
  block.v = candidate.v;
  measureTexture(left, block.u, block.v, block);
  block.centre_u = static_cast<float>(block.u) + block.moment_u / block.slope_energy;
  block.centre_v = static_cast<float>(block.v) + block.moment_v / block.slope_energy;
  return block.grey_energy > kLeastEnergy && block.slope_energy > 0;
}

void PhotometricBlocks::choose(const cv::Mat& left, const StereoRig& rig, const ShiftModel& shift,
                               int count) {
  findCandidates(left, rig, shift);
  usual_energy_ = usualEnergy();
  pick(count);
  size_t made = 0;  // in the memory of the blocks before
  for (const Candidate& candidate : candidates_) {
    if (!candidate.chosen) continue;
    if (made == blocks_.size()) blocks_.emplace_back();
    if (makeBlock(left, candidate, blocks_[made])) ++made;
  }
  blocks_.resize(made);
}

}  // namespace uav_landing
