#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Windows of an image that share pixels, and with them noise.
class WindowOverlap {
 public:
  /// count: windows that memory is taken for.
  explicit WindowOverlap(size_t count);

  /// u, v: the window's middle. extent: its width and height, pixels; 0 when it shares nothing. Windows from
  /// the top of the image down, as corners mostly come, take the least time.
  void add(double u, double v, double extent);

  /// By which the variance of what is fitted to windows is larger than if they shared no noise: the mean over
  /// them of the shares that all windows have of one.
  double factor() const;

 private:
  float shared(size_t i) const;
  size_t firstNear(size_t i) const;

  size_t count_ = 0;
  std::vector<float> u_, v_, extents_;  // filled up to whole lanes
  std::vector<float> lowest_;           // of the windows up to each: those far above one are all at the front
};

}  // namespace uav_landing
