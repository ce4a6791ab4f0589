#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sequences.h"
#include "times.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {
namespace benchmark {

/// What the pairs of a whole sequence take, where the plane is searched for on some of them.
struct SearchingTimes {
  std::string sequence;
  cv::Size size;
  Times pairs;        ///< CPU ms, one for each pair, in their order
  double steady = 0;  ///< CPU ms, median of a flight whose plane is followed, with pictures of this size

  double worstOverSteady() const { return pairs.quantile(1) / steady; }
};

/// Least CPU time of each pair over several flights of a new chain, the first pair included. steady: file of
/// the simulator with the flight to compare with.
Expected<SearchingTimes> measureSearching(const Sequence& sequence, const std::string& steady,
                                          const Parameters& parameters);

}  // namespace benchmark
}  // namespace uav_landing
