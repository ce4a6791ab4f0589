#pragma once

#include <opencv2/core.hpp>

#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Parts of the aircraft that one camera sees, always at the same place of its raw picture.
class OwnFrame {
 public:
  enum class Side { kLeft, kRight };
  OwnFrame(const SimulatedOwnFrameParameters& frame, const SimulatedImageParameters& image, Side camera);

  /// Draws them over a picture of 32-bit floats.
  void draw(cv::Mat& grey) const;

 private:
  void cover(int row, int column, float share, float brightness);
  void addNose(const SimulatedOwnFrameParameters& frame, Side camera);
  void addPost(const SimulatedOwnFrameParameters& frame, Side camera);

  cv::Mat light_, clear_;  ///< what is added to each pixel, and the share that is left of it; empty: nothing
};

}  // namespace uav_landing
