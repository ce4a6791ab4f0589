#include "runway/threshold/runway_top_view.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {

namespace {

constexpr double kFarthest = 60;     // heights
constexpr double kNearest = 0.5;     // heights
constexpr double kFootprint = 0.02;  // largest length of a station on the ground, as a share of the width

}  // namespace

TopView::TopView(const RectifiedView& view, const StereoRig& rig, const GroundAxes& axes,
                 const RunwayCrossSection& runway, std::vector<Across>& rows)
    : image_(view.image),
      mask_(view.mask),
      rig_(rig),
      axes_(axes),
      exposed_(view.rows),
      centre_(runway.centre),
      step_(1 / rig.fy),
      rows_(rows) {
  for (int c = 0; c < kColumns; ++c)
    across_[c] = runway.centre + ((c + 0.5) / kColumns - 0.5) * kAcross * runway.width;
  // Stations are evenly spaced in the inverse of the distance, as pixels are.
  const double farthest = std::min(kFarthest, std::sqrt(kFootprint * runway.width / step_));
  rows_.clear();
  bool begun = false;
  for (int k = 0;; ++k) {
    const double inverse = 1 / kNearest - k * step_;
    if (inverse <= 1 / farthest) break;
    if (!begun && !mayBeSeen(1 / inverse)) continue;
    rows_.emplace_back();
    if (sample(1 / inverse, rows_.back())) {
      begun = true;
      inverse_.push_back(inverse);
    } else {
      rows_.pop_back();
      if (begun) break;
    }
  }
}

/// Quick test. The part of a row that lies in the image is one piece. If the row has enough of it, the sample
/// at its first or its third quarter is in the image.
bool TopView::mayBeSeen(double x) const {
  const auto isSeen = [&](int c) {
    const Eigen::Vector3d point = x * axes_.forward + axes_.down + across_[c] * axes_.left;
    const double u = rig_.fx * point.x() + rig_.cx * point.z(), v = rig_.fy * point.y() + rig_.cy * point.z();
    return point.z() > 0 && u >= 0 && v >= 0 && u < image_.cols * point.z() && v < image_.rows * point.z();
  };
  return isSeen(kColumns / 4) || isSeen(kColumns - 1 - kColumns / 4);
}

bool TopView::sample(double x, Across& row) const {
  if (image_.cols < 2 || image_.rows < 2) return false;
  // A line across the runway covers few rows of the image, so the time of its middle is used for all of it.
  const Eigen::Vector3d begin = x * axes_.forward + axes_.down, middle = begin + centre_ * axes_.left;
  const double seconds = middle.z() > 0 ? exposed_.timeOf(middle) : 0;
  const LineView line{seconds == 0 ? begin : exposed_.pointAfter(seconds, begin),
                      seconds == 0 ? axes_.left : exposed_.directionAfter(seconds, axes_.left),
                      rig_.fx,
                      rig_.fy,
                      rig_.cx,
                      rig_.cy};
  return sampleLine(line, across_, image_, mask_, row) >= kLeastPicture * kColumns;
}

TopView::Across TopView::blockAround(int k) const {
  Across block;
  averageLines(&row(k - kBlock), 2 * kBlock + 1, block);
  return block;
}

double meanOf(const TopView::Across& row) {
  double sum = 0;
  int count = 0;
  for (const float value : row) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace uav_landing
