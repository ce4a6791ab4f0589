#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "geometry/stamp_map.h"
#include "kernels/image/line_view.h"
#include "runway/direction/ground_edges.h"
#include "runway/position/runway_cross_section.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// The runway as seen from above, one row (station) for each pixel of distance. Refers to what it is made of.
class TopView {
 public:
  static constexpr int kColumns = kLineSamples;  ///< samples across the runway
  static constexpr double kAcross = 0.92;        ///< of the width: without the lines along the edges
  static constexpr double kLeastPicture = 0.75;  ///< share of a station's samples that lie in the picture

  /// Grey levels across the runway from the left, not finite outside the picture.
  using Across = LineGreys;

  /// rows: memory for the rows, kept by the caller. exposed: when the image's rows were.
  TopView(const cv::Mat& image, const cv::Mat& mask, const StereoRig& rig, const GroundAxes& axes,
          const RunwayCrossSection& runway, std::vector<Across>& rows, const StampMap& exposed = {});

  int size() const { return static_cast<int>(rows_.size()); }
  const Across& row(int k) const { return rows_[static_cast<size_t>(k)]; }
  /// Mean of 2 kBlock + 1 stations around k.
  Across blockAround(int k) const;
  static constexpr int kBlock = 3;
  /// Forward of the camera, in heights, of a station that need not be whole.
  double distance(double k) const { return 1 / (inverse_.front() - k * step_); }
  /// Of one station, in heights.
  double footprint(double k) const { return step_ * distance(k) * distance(k); }

 private:
  bool mayBeSeen(double x) const;
  bool sample(double x, Across& row) const;

  const cv::Mat &image_, &mask_;
  const StereoRig& rig_;
  const GroundAxes& axes_;
  StampMap exposed_;
  double centre_;  // of the runway, left of the camera, in heights
  double step_;
  LinePlaces across_;  // left of the camera, in heights
  std::vector<double> inverse_;
  std::vector<Across>& rows_;
};

/// Of the samples that are in the picture.
double meanOf(const TopView::Across& row);

}  // namespace uav_landing
