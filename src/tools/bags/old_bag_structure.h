#pragma once

#include <cstdint>

#include "bags/bag_bytes.h"

namespace uav_landing {

/// Checks a bag of format 1.2 as checkBagStructure() does (ROS until 2010,
/// http://wiki.ros.org/Bags/Format/1.2). first_record: position of its first record.
void checkOldBagStructure(const BagBytes& bag, uint64_t first_record);

}  // namespace uav_landing
