#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "kernels/window/window_layout.h"

namespace uav_landing {

/// A square window of an image minus the grey level in its middle, with its gradient, filled up with zeros
/// (window_layout.h).
class WindowPlanes {
 public:
  /// Sums of the values a, the gradient x, y, and of their products.
  struct OwnSums {
    double a, x, y, aa, ax, ay, xx, xy, yy;
  };
  /// Sums of products of the gradient with itself and with the distance from the window's centre.
  struct MomentSums {
    double x, y, xx, xy, yy;
  };
  /// Sums for a window that grows: s = x across + y down is the gradient's response to growth. They are of s
  /// times the distance from the centre (across, down), alone and times the gradient.
  struct GrowthSums {
    double s_across, s_down, x_across, x_down, y_across, y_down;
  };
  struct DistanceSums {
    std::array<MomentSums, 2> moments;  ///< times the distance across, and times the one down
    GrowthSums growth;
  };
  /// Sums over a window b of another image, and of its products with this one.
  struct OtherSums {
    double b, bb, ba, bx, by;
  };

  /// u, v: middle of the window. The window and one pixel around it must be inside the image.
  WindowPlanes(const cv::Mat& image, int u, int v, int radius);

  int radius() const { return radius_; }
  float middle() const { return middle_; }
  int size() const { return 2 * radius_ + 1; }
  int stride() const { return windowStride(radius_); }
  int pixels() const { return size() * size(); }

  OwnSums sums() const;
  DistanceSums distanceSums() const;
  /// other: rows of the other window, with room for all of this one's. Values that fill them up do not
  /// matter.
  OtherSums multiply(WindowValues& other) const;

 private:
  int filled() const { return wholeLanes(size() * stride()); }

  int radius_;
  float middle_;
  alignas(sizeof(Lanes)) WindowValues a_, x_, y_;
};

}  // namespace uav_landing
