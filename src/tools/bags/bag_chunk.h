#pragma once

#include <cstdint>
#include <string>

namespace uav_landing {

/// Content of a compressed chunk of a bag. size: bytes after decompression. compression: "bz2" or "lz4".
/// Throws std::exception when the chunk cannot be decompressed or has another size. It takes no more memory
/// than the compressed bytes can fill.
std::string decompressChunk(const std::string& compression, std::string compressed, uint32_t size);

}  // namespace uav_landing
