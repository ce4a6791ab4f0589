#include "faults/faults.h"

#include <algorithm>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {
namespace {

/// Adds variants of some faults that are there from the first pair on.
void addFromFirst(std::vector<Fault>& all) {
  for (const char* name : {"swapped", "unsynchronised", "bent_pitch_0.2", "bent_yaw_0.2", "bent_roll_0.2",
                           "bent_yaw_1", "focal_right"}) {
    Fault fault = *std::find_if(all.begin(), all.end(), [&](const Fault& f) { return f.name == name; });
    fault.name += "_first";
    fault.meaning += ", from the first pair on";
    fault.from_first = true;
    all.push_back(std::move(fault));
  }
}

}  // namespace

const std::vector<Fault>& allFaults() {
  static const std::vector<Fault> faults = [] {
    std::vector<Fault> all;
    all.push_back(spoils("none", Place::kTiming, "healthy", [](FaultRun&, int, Delivery&) {}));
    addTimingFaults(all);
    addLightFaults(all);
    addSensorFaults(all);
    addLensFaults(all);
    addGroundFaults(all);
    addRowFaults(all);
    addRigFaults(all);
    addFromFirst(all);
    return all;
  }();
  return faults;
}

}  // namespace uav_landing
