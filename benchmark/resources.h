#pragma once

#include <vector>

#include "sequences.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {
namespace benchmark {

/// Largest memory that one chain takes on a sequence, MB: resident, minus what the program had before. NaN
/// when the system does not tell it (Linux does).
double peakMemory(const Sequence& sequence, const Parameters& parameters);

/// Pairs per second of wall-clock time of 1, 2, ... chains side by side, each in its own thread, up to the
/// number of cores and at most 4.
std::vector<double> pairsPerSecond(const Sequence& sequence, const Parameters& parameters);

}  // namespace benchmark
}  // namespace uav_landing
