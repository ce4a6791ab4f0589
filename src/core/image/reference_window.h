#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/patch_refinement.h"
#include "kernels/window/window_planes.h"

namespace uav_landing {

/// Shift and gain of: reference + gradient.shift = gain other + offset, by least squares.
struct GainShift {
  bool solved = false;
  Eigen::Vector2d shift;
  double gain = 0;
  double residual = 0;        ///< sum of squares
  double mean = 0;            ///< of the other window, less the middle of the reference
  Eigen::Vector2d projected;  ///< shift that a unit of gain would look like
  double left_over = 0;       ///< contrast that no shift explains
};

/// A window of the reference, to be compared with places in other images.
class ReferenceWindow {
 public:
  /// own: of this very window. The window and a pixel around it must be inside the image.
  ReferenceWindow(const cv::Mat& reference, int u, int v, int radius, OwnTexture& own);

  bool usable() const { return own_.usable; }  ///< for shifts in both directions
  const OwnTexture& own() const { return own_; }
  int radius() const { return planes_.radius(); }
  int count() const { return planes_.pixels(); }
  /// Places to the right of the centre that are looked at, those filled up included.
  int paddedReach() const { return planes_.stride() - planes_.radius() - 1; }

  /// The other image from `at` on. The window must be inside by two pixels and paddedReach().
  WindowPlanes::OtherSums look(const cv::Mat& other, const Eigen::Vector2d& at,
                               const Eigen::Matrix2d& warp) const;
  /// The same where rows stay rows: this row's place, and what it moves from pixel to pixel and row to row.
  WindowPlanes::OtherSums lookAlongRow(const cv::Mat& other, int v, double place, double scale,
                                       double shear) const;
  GainShift solve(const WindowPlanes::OtherSums& sums) const;
  /// distances: whether moments and growth are wanted, too.
  PatchRefinement::Evidence evidence(const GainShift& found, bool distances) const;

 private:
  WindowPlanes planes_;
  OwnTexture& own_;
};

}  // namespace uav_landing
