#include "bags/bag_chunk.h"

#include <bzlib.h>
#include <rosbag/chunked_file.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace uav_landing {
namespace {

std::runtime_error otherSize(uint64_t found, uint32_t size) {
  return std::runtime_error(std::to_string(found) + " bytes of content, expected " + std::to_string(size));
}

/// The memory grows with the output, because the size in the file may be anything and bzip2 has no limit of
/// compression.
std::string decompressBz2(std::string& compressed, uint32_t size) {
  bz_stream stream{};
  stream.next_in = compressed.data();
  stream.avail_in = static_cast<unsigned>(compressed.size());
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const size_t most = size_t{size} + 1;  // one more byte shows that there is more
  std::string content;
  size_t filled = 0;
  int status = BZ_OK;
  while (status == BZ_OK && filled < most) {
    if (filled == content.size()) content.resize(std::min(most, std::max<size_t>(2 * filled, 1 << 16)));
    stream.next_out = content.data() + filled;
    stream.avail_out = static_cast<unsigned>(content.size() - filled);
    status = BZ2_bzDecompress(&stream);
    const size_t now = content.size() - stream.avail_out;
    if (now == filled && stream.avail_in == 0) break;  // cut off
    filled = now;
  }
  BZ2_bzDecompressEnd(&stream);
  if (filled == most) throw std::runtime_error("more content than " + std::to_string(size) + " bytes");
  if (status != BZ_STREAM_END) throw std::runtime_error("no intact bzip2 data");
  if (filled != size) throw otherSize(filled, size);
  content.resize(size);
  return content;
}

/// roslz4 copies each block into a buffer of the largest size that the frame's header allows, however long
/// the block is. So the blocks are checked first. https://github.com/lz4/lz4/blob/dev/doc/lz4_Frame_format.md
void checkLz4Blocks(const std::string& frame) {
  constexpr size_t kHeader = 7, kDescription = 5;
  const std::runtime_error damaged("no intact lz4 data");
  if (frame.size() < kHeader) throw damaged;
  const int id = (frame[kDescription] >> 4) & 7;
  if (id < 4) throw damaged;
  const uint32_t largest = 1u << (8 + 2 * id);
  for (size_t at = kHeader; frame.size() - at >= sizeof(uint32_t);) {
    uint32_t block;
    std::memcpy(&block, frame.data() + at, sizeof block);
    block &= 0x7fffffff;  // the highest bit tells whether it is compressed
    if (block == 0) return;
    if (block > largest) throw damaged;
    at += std::min<size_t>(sizeof block + block, frame.size() - at);
  }
}

std::string decompressLz4(std::string& compressed, uint32_t size) {
  constexpr uint64_t kMostPerByte = 255;  // limit of the format
  checkLz4Blocks(compressed);
  if (size > kMostPerByte * compressed.size()) throw otherSize(kMostPerByte * compressed.size(), size);
  std::string content(size, '\0');
  rosbag::ChunkedFile().decompress(rosbag::compression::LZ4, reinterpret_cast<uint8_t*>(content.data()), size,
                                   reinterpret_cast<uint8_t*>(compressed.data()),
                                   static_cast<unsigned>(compressed.size()));
  return content;
}

}  // namespace

std::string decompressChunk(const std::string& compression, std::string compressed, uint32_t size) {
  return compression == "bz2" ? decompressBz2(compressed, size) : decompressLz4(compressed, size);
}

}  // namespace uav_landing
