#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "image/input/rectified_view.h"
#include "kernels/image/line_view.h"
#include "runway/direction/ground_edges.h"
#include "runway/edges/runway_cross_section.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The runway seen from above. A row (station) corresponds to one pixel of distance. The object refers to the
/// view's image and mask, the rig, the axes and the rows, which must outlive it.
class TopView {
 public:
  static constexpr int kColumns = kLineSamples;  ///< samples across the runway
  /// Share of the width that is sampled, without the lines along the edges.
  static constexpr double kAcross = 0.92;
  static constexpr double kLeastPicture = 0.75;  ///< least share of a station's samples that lie in the image

  /// Grey levels across the runway from left to right. They are not finite outside the image.
  using Across = LineGreys;

  /// view: of the left camera. rows: memory for the rows, kept by the caller.
  TopView(const RectifiedView& view, const StereoRig& rig, const GroundAxes& axes,
          const RunwayCrossSection& runway, std::vector<Across>& rows);

  int size() const { return static_cast<int>(rows_.size()); }
  const Across& row(int k) const { return rows_[static_cast<size_t>(k)]; }
  /// Mean of the 2 kBlock + 1 stations around k.
  Across blockAround(int k) const;
  static constexpr int kBlock = 3;
  /// Distance of a station ahead of the camera, in heights. k need not be whole.
  double distance(double k) const { return 1 / (inverse_.front() - k * step_); }
  /// Length of a station on the ground, in heights.
  double footprint(double k) const { return step_ * distance(k) * distance(k); }

 private:
  bool mayBeSeen(double x) const;
  bool sample(double x, Across& row) const;

  const cv::Mat &image_, &mask_;
  const StereoRig& rig_;
  const GroundAxes& axes_;
  StampMap exposed_;
  double centre_;  // lateral place of the runway's centre, left positive, in heights
  double step_;
  LinePlaces across_;  // lateral places of the samples, left positive, in heights
  std::vector<double> inverse_;
  std::vector<Across>& rows_;
};

/// Mean of the samples that are in the image.
double meanOf(const TopView::Across& row);

}  // namespace uav_landing
