#include "stereo/photometric/band_disparities.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stereo/rows/vertical_disparity.h"

namespace uav_landing {
namespace {

// Ground with a smaller disparity (pixels) is too near the horizon to tell the height.
constexpr double kLeastDisparity = 0.3;
// Blocks of a row are joined, at most so many, until they know the shift to kKnown (1 sigma, pixels). Groups
// that know it less well than kLeastKnown are dropped.
constexpr int kTogether = 8;
constexpr double kKnown = 0.25, kLeastKnown = 1.0;

}  // namespace

BandDisparities::BandDisparities(const StereoLevel& level)
    : rig_(level.rig),
      rows_(level.left_mask, level.right_mask),
      grey_(cv::Mat::zeros(rig_.size, CV_32F)),
      straightened_(cv::Mat::zeros(rig_.size, CV_32F)),
      left_(rig_.size),
      right_(rig_.size) {}

bool BandDisparities::isSeen(int column, int line) const {
  constexpr int kAround = 4;  // pixels beside those that are filled up
  const int u = kGridColumn + column * kBlockWidth, v = grid_.first_row + line * kBlockHeight;
  for (int row = v; row < v + kBlockHeight; ++row) {
    const cv::Range& seen = rows_.seen(row);
    if (u - kAround < seen.start || u + kBlockWidth + kAround > seen.end) return false;
  }
  return true;
}

void BandDisparities::choose(const cv::Mat& left, const PlaneVector& g, const PlaneDrift& drift) {
  rows_.begin(left, ShiftModel(rig_, g, drift), kLeastDisparity + rig_.principalOffset());
  grid_.columns = std::max(0, (left.cols - 2 * kGridColumn) / kBlockWidth);
  const int height = std::max(0, rows_.left().rows - 2 * kGridRow);
  grid_.lines = height / kBlockHeight;
  // The lowest rows tell most, so the grid is placed such that a block contains them.
  grid_.first_row = kGridRow + height % kBlockHeight / 2 * 2;
  grid_.seen.clear();
  for (int line = 0; line < grid_.lines; ++line)
    for (int column = 0; column < grid_.columns; ++column) grid_.seen.push_back(isSeen(column, line));
  if (!grid_.seen.empty()) left_.split(rows_.left());
}

// When rows are not level, the images are straightened: derivatives tell too little about the effect on fine
// texture.
void BandDisparities::takeRight(const cv::Mat& right, const RigRotation& rows) {
  right.convertTo(grey_, CV_32F);
  level_ = grey_;
  if (rows.w.isZero()) return;
  const int first = rows_.firstRow();
  straightenRows(rig_, rows.w, grey_, straightened_, {first, first + rows_.left().rows});
  level_ = straightened_;
}

void BandDisparities::measure(const PlaneVector& g, const PlaneDrift& drift) {
  disparities_.clear();
  differ_by_noise_ = false;
  if (std::find(grid_.seen.begin(), grid_.seen.end(), 1) == grid_.seen.end()) return;
  const ShiftModel shift(rig_, g, drift);
  rows_.align(level_, shift);
  right_.split(rows_.right());
  weigh();
  for (int line = 0; differ_by_noise_ && line < grid_.lines; ++line) tellLine(line, shift);
}

void BandDisparities::weigh() {
  constexpr int kCoarsest = TextureBands::kBands - 1;
  // Rectification reduces noise in the finest band only, but images of different things differ in all bands.
  constexpr double kMostCoarse = 4 * TextureBands::kWhiteCoarsest;
  evidence_.assign(grid_.seen.size(), {});
  scores_.clear();
  differ_by_noise_ = false;
  std::array<double, TextureBands::kBands> residuals;
  std::optional<double> gain;
  // The coarsest band has the least noise, so it knows the gain best.
  for (int band = kCoarsest; band >= 0; --band) {
    addUp(left_[band], right_[band], TextureBands::factor(band), grid_, sums_);
    if (!gain) gain = gainOf(sums_);
    if (!gain) return;
    addNeighbours(grid_, sums_, around_);
    const BandNoise noise = noiseOf(grid_, around_, *gain);
    residuals[band] = noise.residual;
    addEvidence(grid_, {sums_, around_, *gain, noise, TextureBands::noise(band)}, scores_, evidence_);
  }
  differ_by_noise_ = residuals[kCoarsest] <= kMostCoarse * residuals[0];
}

void BandDisparities::tellLine(int line, const ShiftModel& shift) {
  const double v = rows_.firstRow() + grid_.first_row + (line + 0.5) * kBlockHeight - 0.5;
  std::array<Group, 2> groups;  // of blocks that do not look alike, and of those that do
  for (int column = 0; column < grid_.columns; ++column) {
    const BandEvidence& block = evidence_[grid_.at(column, line)];
    const bool last = (column + 1) % kTogether == 0 || column + 1 == grid_.columns;
    if (block.information > 0)
      groups[block.looksAlike()].add(block, kGridColumn + (column + 0.5) * kBlockWidth - 0.5);
    for (Group& group : groups) {
      if (!last && group.sum.stddev() > kKnown) continue;
      if (group.sum.stddev() < kLeastKnown) tell(group, v, shift);
      group = {};
    }
  }
}

void BandDisparities::Group::add(const BandEvidence& block, double u) {
  sum.add(block);
  place += block.information * u;
  ++blocks;
}

void BandDisparities::tell(const Group& group, double v, const ShiftModel& shift) {
  const BandEvidence& sum = group.sum;
  const double u = group.place / sum.information;
  const ShiftMatch match{u, v, sum.shift(), sum.stddev(), sum.lean(), group.blocks, false, sum.looksAlike()};
  disparities_.push_back(disparityOf(match, rig_, shift, Eigen::Vector3d::Zero()));
}

}  // namespace uav_landing
