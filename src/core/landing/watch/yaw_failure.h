#pragma once

#include "landing/height/pair_input.h"
#include "landing/watch/pair_monitor.h"

namespace uav_landing {

/// Returns why the pair's direction must not be taken for the runway's; no failure when it may be. pair:
/// result of its tests.
Failure yawFailure(const PairInput& in, const PairVerdict& pair);

}  // namespace uav_landing
