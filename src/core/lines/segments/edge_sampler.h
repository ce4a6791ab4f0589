#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core.hpp>

#include "kernels/edges/edge_peaks.h"
#include "lines/segments/edge_picture.h"
#include "lines/segments/line_fit.h"

namespace uav_landing::line_fit {

/// The pixels across a line at a station, along the station's row or column. Only whole pixels are read,
/// because interpolation would bias the peak by up to 0.1 px.
struct Station {
  static constexpr int kRadius = 3;  ///< px on each side at which there are gradients

  int centre;         ///< column or row of the pixel nearest to the line
  const uchar* grey;  ///< this pixel among those across the line; null outside image and ground

  /// Twice the gradient along the row or column, k pixels from the line; |k| <= kRadius.
  int twiceGradient(int k) const { return grey[k + 1] - grey[k - 1]; }
};

/// Axes of a line, and how gradients along rows or columns become gradients across the line, positive when
/// brighter `across`.
struct LineFrame : LineAxes {
  explicit LineFrame(const Axis& axis)
      : LineAxes{axis.origin[axis.major],      axis.origin[axis.minor], axis.along[axis.major],
                 axis.along[axis.minor],       axis.across[axis.major], axis.across[axis.minor],
                 0.5 / axis.across[axis.minor]} {}
};

/// An edge of one kind: its sign (+1: brighter towards `across`) and the weakest gradient, grey/px.
struct EdgeKind {
  int sign;
  double min_gradient;
};

/// Looks along one line. It refers to the pixels of the picture and to the axis, which must outlive it.
class EdgeSampler {
 public:
  EdgeSampler(const EdgePicture& picture, const Axis& axis, const EdgeKind& kind)
      : EdgeSampler(axis.minor == 0 ? picture.image : picture.transposed, picture.ground, axis, kind) {}

  const Axis& axis() const { return axis_; }
  const LineFrame& frame() const { return frame_; }

  Station at(int station) const {
    const int centre = cvRound(first_ + slope_ * station);
    if (!isInside(station, centre) || !isGround(station, centre)) return {centre, nullptr};
    return {centre, pixels_ + station * step_ + centre};
  }

  /// The strongest gradient within a pixel of the line; false when there is none of this kind.
  bool findEdge(int station, StationEdge& edge) const;

  /// The same within reach px (1 or 2), between two distances along the line. It looks at no more than most
  /// rows or columns, evenly spread.
  void collect(int reach, double from, double to, int most, Peaks& peaks) const;

 private:
  /// pixels: one row per station.
  EdgeSampler(const cv::Mat& pixels, const cv::Mat& ground, const Axis& axis, const EdgeKind& kind);

  bool isInside(int station, int centre) const {
    constexpr int kReach = Station::kRadius + 1;
    return centre >= kReach && centre < size_ - kReach && station >= 0 && station < stations_;
  }
  bool isGround(int station, int centre) const {
    return ground_[station * to_next_station_ + centre * to_neighbour_] != 0;
  }
  Stations inside(Stations stations) const;

  const uchar *pixels_, *ground_;
  std::ptrdiff_t step_, to_next_station_, to_neighbour_;  // step_: of pixels_; the others: in ground_
  int size_, stations_;                                   // columns and rows of pixels_
  const Axis& axis_;
  LineFrame frame_;
  double slope_, first_;  // of the line: px across by station, and where it crosses station 0
  short least_;           // twice the weakest gradient along a row or column
  short sign_;            // sign of such gradients
};

}  // namespace uav_landing::line_fit
