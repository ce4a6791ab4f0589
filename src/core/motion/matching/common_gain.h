#pragma once

#include <limits>
#include <vector>

namespace uav_landing {

/// Mean grey levels of the two windows around one corner.
struct WindowMeans {
  double now, then;
};

/// Factor that makes the image then as bright as the image now.
struct CommonGain {
  double gain = 1;
  /// Infinite when the windows do not determine the gain.
  double variance = std::numeric_limits<double>::infinity();
};

/// Fits a straight line to the means of the windows, now over then. Its slope is the gain; neither blur nor
/// noise changes it. Windows more than three standard deviations off the line are rejected. The variance does
/// not fall with the number of windows: errors often have a common cause, such as paint brighter than the
/// camera can see.
CommonGain commonGain(const std::vector<WindowMeans>& windows);

}  // namespace uav_landing
