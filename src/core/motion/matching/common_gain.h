#pragma once

#include <limits>
#include <vector>

namespace uav_landing {

/// Mean grey levels of the windows around a corner.
struct WindowMeans {
  double now, then;
};

/// By what the image then is to be multiplied to be as bright as the one now.
struct CommonGain {
  double gain = 1;
  double variance = std::numeric_limits<double>::infinity();  ///< without a limit when nothing tells it
};

/// The slope of the straight line through the windows' means, now over then, which neither blur nor noise
/// changes; without those more than three stddevs off the line. Windows off the line are so for a cause that
/// many share, as paint brighter than the camera can see: more of them tell the line no better.
CommonGain commonGain(const std::vector<WindowMeans>& windows);

}  // namespace uav_landing
