#pragma once

#include <vector>

namespace uav_landing {

/// A matched pixel with its disparity. Before the plane is known there may be several possible ones.
struct DisparitySample {
  double u = 0, v = 0;
  double stddev = 0;             ///< pixels of disparity
  double disparity = 0;          ///< pixels
  std::vector<double> others{};  ///< further possible disparities, pixels; mostly none
};

}  // namespace uav_landing
