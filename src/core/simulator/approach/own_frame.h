#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Parts of the aircraft that one camera sees. They are always at the same place of its raw image.
class OwnFrame {
 public:
  enum class Side { kLeft, kRight };
  OwnFrame(const SimulatedOwnFrameParameters& frame, const SimulatedImageParameters& image, Side camera);

  /// Draws them over an image of 32-bit floats.
  void draw(cv::Mat& grey) const;

 private:
  void cover(int row, int column, float share, float brightness);
  void addNose(const SimulatedOwnFrameParameters& frame, Side camera);
  void addPost(const SimulatedOwnFrameParameters& frame, Side camera);

  /// light_ is added to each pixel, and clear_ is the share that remains of it; empty: nothing.
  cv::Mat light_, clear_;
};

}  // namespace uav_landing
