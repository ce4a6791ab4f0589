#pragma once

#include <functional>

#include "faults/fault_choice.h"
#include "faults/fault_score.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Called after each pair that counts. It gets the time, the result, the truth at the pair's time on the
/// flight, and whether the fault was there.
using FaultObserver = std::function<void(double time, const LandingResult&, const FaultTruth&, bool faulted)>;

/// Flies a flight with faults through the chain.
/// in_flight: first frame with the faults that begin in flight.
/// onset: frame from which on faults are scored.
/// seed: for the random numbers of the faults.
/// observe: may be empty.
FaultScore flyWithFaults(const Flight& flight, const FaultCombination& faults, int in_flight, int onset,
                         uint64_t seed, const Parameters& parameters, const FaultObserver& observe);

}  // namespace uav_landing
