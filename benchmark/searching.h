#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sequences.h"
#include "times.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {
namespace benchmark {

/// Times of the pairs of a whole sequence, on some of which the plane is searched for.
struct SearchingTimes {
  std::string sequence;
  cv::Size size;
  Times pairs;        ///< CPU ms, one per pair, in their order
  double steady = 0;  ///< CPU ms, median of a flight whose plane is followed, with images of this size

  double worstOverSteady() const { return pairs.quantile(1) / steady; }
};

/// Smallest CPU time of each pair over several flights of a new chain, the first pair included. steady: file
/// of the simulator with the flight to compare with.
Expected<SearchingTimes> measureSearching(const Sequence& sequence, const std::string& steady,
                                          const Parameters& parameters);

}  // namespace benchmark
}  // namespace uav_landing
