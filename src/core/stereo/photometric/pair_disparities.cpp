#include "stereo/photometric/pair_disparities.h"

namespace uav_landing {
namespace {

// When images are clear, at least this share of the blocks is beyond doubt.
constexpr double kMostlyCertain = 0.5;

}  // namespace

PairDisparities::PairDisparities(const RigModel& model, int margin)
    : blocks_(reduceLevel(model, 1, margin)), bands_(reduceLevel(model, 1, margin)) {}

void PairDisparities::begin(const cv::Mat& left, const cv::Mat& right, const PlaneVector& g,
                            const RigRotation& rows, const PlaneDrift& drift) {
  blocks_.choose(left, g, drift);
  blocks_.measure(right, g, rows, drift);
  faint_ = blocks_.certainShare() < kMostlyCertain;
  by_bands_ = false;
  if (faint_) {
    bands_.choose(left, g, drift);
    bands_.takeRight(right, rows);
  }
  collect();
}

void PairDisparities::measure(const cv::Mat& right, const PlaneVector& g, const RigRotation& rows,
                              const PlaneDrift& drift) {
  if (faint_) bands_.measure(g, drift);
  faint_ = by_bands_ = faint_ && bands_.differByNoise();
  if (!by_bands_) blocks_.measure(right, g, rows, drift);
  collect();
}

void PairDisparities::collect() {
  found_.clear();
  informative_ = 0;
  for (const BlockDisparity& disparity : by_bands_ ? bands_.disparities() : blocks_.disparities()) {
    informative_ += disparity.blocks;
    if (disparity.alike) found_.push_back(disparity);
  }
}

}  // namespace uav_landing
