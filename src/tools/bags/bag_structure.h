#pragma once

#include <string>

namespace uav_landing {

/// Checks a bag before rosbag reads it. rosbag trusts the lengths and positions in the file: where they are
/// wrong it reads and writes beyond its buffers. This goes the way that rosbag goes (file header,
/// connections, chunks and their indexes, every message that an index names) and compares each length with
/// what is left of the file or of the chunk. Messages are skipped over; chunks that are compressed have to be
/// decompressed.
///
/// Throws std::runtime_error, "damaged at byte N: what is there, and what was expected". Says nothing about
/// bags without an index and about formats that rosbag does not know. http://wiki.ros.org/Bags/Format/2.0
void checkBagStructure(const std::string& path);

}  // namespace uav_landing
