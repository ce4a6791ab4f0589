#pragma once

#include <Eigen/Core>
#include <array>

#include "far/outline.h"

namespace uav_landing {

/// Parameters of the model: the places of the sides (8), the blur, and amplitudes. Those of lines are in grey
/// levels times m.
enum OutlineParameter {
  kBlur = 8,
  kGround,                 ///< four: a mean, and how it changes over the image
  kSurface = kGround + 4,  ///< two: at the near and at the far end, against the ground
  kStripes = kSurface + 2,
  kMiddle,  ///< the centre line
  kNearBars,
  kFarBars,
  kOutlineParameters
};
using OutlineVector = Eigen::Matrix<double, kOutlineParameters, 1>;
using OutlineMatrix = Eigen::Matrix<double, kOutlineParameters, kOutlineParameters>;

/// The grey levels around a runway's outline, and their derivatives. See fitOutline().
class OutlineModel {
 public:
  /// Band of pixels around the outline that tell of its sides, px.
  static constexpr double kOutside = 7, kInside = 8;

  OutlineModel(const Corners& reference, const OutlineLook& look);

  /// 1 sigma by which what is painted across at an end moves the side, px.
  double marksAcross(int side) const {
    return side == kNearSide ? marks_across_[0] : side == kFarSide ? marks_across_[1] : 0;
  }
  /// False for a pixel that tells nothing of a side.
  bool mayTell(const Eigen::Vector2d& pixel) const;
  /// Value at a pixel, and its derivatives.
  double at(const Eigen::Vector2d& pixel, const OutlineVector& p, OutlineVector& slope) const;

 private:
  /// Where a pixel is.
  struct Place {
    double share[kSides];   // along each side, from its first end
    double inward[kSides];  // of each side, px
    double rise[kSides];    // derivative of the share of the pixel that is inside of the side
    double across, along;   // share of the pixel between the long sides, and between the ends
    double beyond;          // from the near side (0) to the far one (1)
    double scale;           // px a metre
  };
  Place placeOf(const Eigen::Vector2d& pixel, const OutlineVector& p) const;

  std::array<OutlineSide, kSides> sides_;
  double width_, near_width_, far_width_;
  double bars_[2], far_bars_[2];  // px from the sides
  double marks_across_[2];        // of the near and the far side
  Eigen::Vector2d middle_;
};

}  // namespace uav_landing
