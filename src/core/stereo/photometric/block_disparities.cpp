#include "stereo/photometric/block_disparities.h"

namespace uav_landing {
namespace {

// Blocks compared: about 100 thousand pixels, which contain nearly all the information of an image.
constexpr int kBlocks = 800;

}  // namespace

BlockDisparities::BlockDisparities(const StereoLevel& level)
    : rig_(level.rig), blocks_(level.left_mask, level.right_mask) {}

void BlockDisparities::choose(const cv::Mat& left, const PlaneVector& g, const PlaneDrift& drift) {
  blocks_.choose(left, rig_, ShiftModel(rig_, g, drift), kBlocks);
}

void BlockDisparities::measure(const cv::Mat& right, const PlaneVector& g, const RigRotation& rows,
                               const PlaneDrift& drift) {
  const ShiftModel shift(rig_, g, drift);
  blocks_.compare(right, shift, matches_);
  disparities_.clear();
  for (const PhotometricBlocks::Match& match : matches_)
    disparities_.push_back(disparityOf(match, rig_, shift, rows.w));
}

double BlockDisparities::certainShare() const {
  int certain = 0, all = 0;
  for (const PhotometricBlocks::Match& match : matches_) {
    all += match.blocks;
    if (match.certain) certain += match.blocks;
  }
  return all > 0 ? static_cast<double>(certain) / all : 0;
}

}  // namespace uav_landing
