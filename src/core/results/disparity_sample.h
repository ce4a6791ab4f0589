#pragma once

#include <vector>

namespace uav_landing {

/// A matched pixel with its disparity, or several that it may have before the plane is known.
struct DisparitySample {
  double u = 0, v = 0;
  double stddev = 0;             ///< pixels of disparity
  double disparity = 0;          ///< pixels
  std::vector<double> others{};  ///< further disparities that it may have instead; mostly none
};

}  // namespace uav_landing
