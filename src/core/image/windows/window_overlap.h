#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Windows of an image that share pixels, and so share noise.
class WindowOverlap {
 public:
  /// count: number of windows for which memory is taken.
  explicit WindowOverlap(size_t count);

  /// u, v: the window's middle. extent: its width and height, pixels; 0 when it shares nothing. Windows
  /// ordered from the top of the image down, as corners mostly are, take the least time.
  void add(double u, double v, double extent);

  /// Factor on the variance of a fit to the windows, because they share noise. It is the mean, over the
  /// windows, of the summed shares that all windows have of one.
  double factor() const;

 private:
  float shared(size_t i) const;
  size_t firstNear(size_t i) const;

  size_t count_ = 0;
  std::vector<float> u_, v_, extents_;  // filled up to whole lanes
  std::vector<float> lowest_;           // largest v up to each window; windows far above a given one are all
                                        // at the front
};

}  // namespace uav_landing
