#pragma once

#include <vector>

#include "sequences.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {
namespace benchmark {

/// Most memory that one chain takes on a sequence, MB: resident, over what the program had before. Not a
/// number where the system does not tell (Linux does).
double peakMemory(const Sequence& sequence, const Parameters& parameters);

/// Pairs a second of wall-clock time of 1, 2, ... chains side by side, each in a thread of its own, up to the
/// number of cores and at most 4.
std::vector<double> pairsPerSecond(const Sequence& sequence, const Parameters& parameters);

}  // namespace benchmark
}  // namespace uav_landing
