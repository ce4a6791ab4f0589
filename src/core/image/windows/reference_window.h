#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "image/windows/patch_refinement.h"
#include "kernels/window/window_planes.h"

namespace uav_landing {

/// Least squares solution of: reference + gradient.shift = gain other + offset.
struct GainShift {
  bool solved = false;
  Eigen::Vector2d shift;
  double gain = 0;
  double residual = 0;        ///< sum of squares
  double mean = 0;            ///< of the other window, less the middle pixel of the reference
  Eigen::Vector2d projected;  ///< shift that looks like a unit of gain
  double left_over = 0;       ///< contrast that no shift explains
};

/// A square window of an image.
struct SquareWindow {
  int u, v;    ///< middle pixel
  int radius;  ///< pixels from the middle to each side

  /// Whether the window, and so many more pixels around it, are inside an image.
  bool isInside(const cv::Mat& image, int margin) const {
    const int reach = radius + margin;
    return u >= reach && v >= reach && u + reach < image.cols && v + reach < image.rows;
  }
};

/// A window of the reference, for comparison with places in other images.
class ReferenceWindow {
 public:
  /// own: of this very window. The window and one pixel around it must be inside the image.
  ReferenceWindow(const cv::Mat& reference, const SquareWindow& window, OwnTexture& own);

  bool usable() const { return own_.usable; }  ///< for shifts in both directions
  const OwnTexture& own() const { return own_; }
  int radius() const { return planes_.radius(); }
  int count() const { return planes_.pixels(); }
  /// Places read to the right of the centre, including those that fill up a lane.
  int paddedReach() const { return planes_.stride() - planes_.radius() - 1; }

  /// Reads the other image at `at`. The window must be inside by two pixels and by paddedReach().
  WindowPlanes::OtherSums look(const cv::Mat& other, const Eigen::Vector2d& at,
                               const Eigen::Matrix2d& warp) const;
  /// The same when rows stay rows. place, scale, shear: column of the middle row, and its change from pixel
  /// to pixel and from row to row.
  WindowPlanes::OtherSums lookAlongRow(const cv::Mat& other, int v, double place, double scale,
                                       double shear) const;
  GainShift solve(const WindowPlanes::OtherSums& sums) const;
  /// distances: whether moments and growth are needed, too.
  PatchRefinement::Evidence evidence(const GainShift& found, bool distances) const;

 private:
  WindowPlanes planes_;
  OwnTexture& own_;
};

}  // namespace uav_landing
