#include "stereo/pair_disparities.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Along each side, the pixels whose mean is one of the halved images.
constexpr int kHalved = 2;
// Nothing is halved where this share of the blocks is beyond doubt.
constexpr double kMostlyCertain = 0.5;
// Pixels of a cell, which is looked at in one resolution: enough for its blocks to tell which. Blocks that
// speak together are in one cell, those of the halved images, too.
constexpr int kCellWidth = kHalved * PhotometricBlocks::kTogether * PhotometricBlocks::kWidth;
constexpr int kCellHeight = 2 * kHalved * PhotometricBlocks::kHeight;

}  // namespace

PairDisparities::PairDisparities(const RigModel& model, int margin)
    : whole_(reduceLevel(model, 1, margin), 1),
      cells_(model.rig.size.width / kCellWidth + 1, model.rig.size.height / kCellHeight + 1),
      is_halved_(cells_.area()) {
  const cv::Size size = model.rig.size / kHalved;
  if (size.width < PhotometricBlocks::kWidth || size.height < PhotometricBlocks::kHeight) return;
  halved_.emplace(reduceLevel(model, kHalved, margin / kHalved), kHalved);
}

void PairDisparities::begin(const cv::Mat& left, const cv::Mat& right, const Eigen::Vector3d& g,
                            const RigRotation& rows) {
  whole_.choose(left, g);
  whole_.measure(right, g, rows);
  std::fill(is_halved_.begin(), is_halved_.end(), 0);
  if (halved_ && whole_.certainShare() < kMostlyCertain) lookAtHalved(left, right, g, rows);
  collect();
}

void PairDisparities::lookAtHalved(const cv::Mat& left, const cv::Mat& right, const Eigen::Vector3d& g,
                                   const RigRotation& rows) {
  reduceImage(left, kHalved, halved_left_);
  reduceImage(right, kHalved, halved_right_);
  halved_->choose(halved_left_, g);
  halved_->measure(halved_right_, g, rows);
  whole_.measureResponse(right, g, rows);
  halved_->measureResponse(halved_right_, g, rows);
  chooseResolutions();
}

void PairDisparities::measure(const cv::Mat& right, const Eigen::Vector3d& g, const RigRotation& rows) {
  whole_.measure(right, g, rows);
  if (anyHalved()) halved_->measure(halved_right_, g, rows);
  collect();
}

size_t PairDisparities::cellOf(const BlockDisparity& disparity) const {
  const int column = static_cast<int>(disparity.sample.u) / kCellWidth;
  const int row = static_cast<int>(disparity.sample.v) / kCellHeight;
  return static_cast<size_t>(row) * cells_.width + column;
}

bool PairDisparities::anyHalved() const {
  return std::find(is_halved_.begin(), is_halved_.end(), 1) != is_halved_.end();
}

void PairDisparities::chooseResolutions() {
  std::vector<double> gains(is_halved_.size(), 0);  // of information by halving, 1/pixels^2
  const auto add = [&](const BlockDisparities& part, double sign) {
    for (const BlockDisparity& disparity : part.disparities())
      if (disparity.alike) gains[cellOf(disparity)] += sign / std::pow(disparity.sample.stddev, 2);
  };
  add(*halved_, 1);
  add(whole_, -1);
  for (size_t i = 0; i < gains.size(); ++i) is_halved_[i] = gains[i] > 0;
}

void PairDisparities::collect() {
  found_.clear();
  informative_ = 0;
  const auto add = [&](const BlockDisparities& part, bool are_halved) {
    for (const BlockDisparity& disparity : part.disparities()) {
      if (is_halved_[cellOf(disparity)] != are_halved) continue;
      informative_ += disparity.blocks;
      if (disparity.alike) found_.push_back(disparity);
    }
  };
  add(whole_, false);
  if (anyHalved()) add(*halved_, true);
}

}  // namespace uav_landing
