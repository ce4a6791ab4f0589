#pragma once

#include <cstdint>

#include "bags/bag_bytes.h"

namespace uav_landing {

/// As checkBagStructure, for a bag of format 1.2 (ROS until 2010, http://wiki.ros.org/Bags/Format/1.2), whose
/// first record is there.
void checkOldBagStructure(const BagBytes& bag, uint64_t first_record);

}  // namespace uav_landing
