#pragma once

#include <string>

namespace uav_landing {

/// Checks a bag before rosbag reads it. rosbag trusts the lengths and positions in the file. If they are
/// wrong, it reads and writes beyond its buffers.
///
/// This function reads as rosbag does: file header, connections, chunks and their indexes, and every message
/// that an index names. It compares each length with what is left of the file or of the chunk. Messages are
/// skipped; compressed chunks have to be decompressed. Throws std::runtime_error, "damaged at byte N: what is
/// there, and what was expected". Format 1.2 is refused. Bags without an index are not reported, nor formats
/// that rosbag does not know. http://wiki.ros.org/Bags/Format/2.0
void checkBagStructure(const std::string& path);

}  // namespace uav_landing
