#pragma once

#include "landing/height/pair_input.h"
#include "landing/watch/pair_monitor.h"

namespace uav_landing {

/// Why the direction that the pair sees is not to be taken for the runway's; none where it may be. pair: what
/// the tests say of it.
Failure yawFailure(const PairInput& in, const PairVerdict& pair);

}  // namespace uav_landing
