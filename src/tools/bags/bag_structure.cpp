#include "bags/bag_structure.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "bags/bag_bytes.h"
#include "bags/bag_chunk.h"
#include "bags/bag_records.h"

namespace uav_landing {
namespace {

// rosbag keeps the size of a chunk in an int. Its own chunks have 768 kB plus one message.
constexpr uint32_t kLargestChunk = 1u << 30;  // bytes

/// Follows rosbag::Bag::startReadingVersion200 and instantiateBuffer.
class Walk {
 public:
  explicit Walk(const std::string& path) : file_(path) {}

  void run() {
    int version = 0;
    const size_t first_line = lengthOfFirstLine(version);
    if (version == 102)
      throw std::runtime_error(
          "in format 1.2, of ROS before 2010; play it with `rosbag play` and record it with `rosbag record`");
    if (version != 200) return;
    BagRecords records = from(first_line);
    const BagFields header = records.header(BagOperation::kFileHeader, "the file header");
    const auto index = records.field<uint64_t>(header, "index_pos", first_line);
    if (index == 0) return;
    const auto encryptor = header.find("encryptor");
    if (encryptor != header.end() && !encryptor->second.empty())
      throw std::runtime_error("encrypted by " + encryptor->second + "; decrypt it, with `rosbag decrypt`");
    const auto connections = records.field<uint32_t>(header, "conn_count", first_line);
    const auto chunks = records.field<uint32_t>(header, "chunk_count", first_line);
    records.number("the length of the padding");

    BagRecords list = from(index);
    for (uint32_t i = 0; i < connections; ++i) readConnection(list);
    for (uint32_t i = 0; i < chunks; ++i) readChunkInfo(list);
    for (const ChunkInfo& chunk : chunks_) readIndexes(chunk);
    for (const auto& [at, offsets] : messages_) checkMessages(at, offsets);
  }

 private:
  struct ChunkInfo {
    uint64_t at;
    size_t indexes;
  };

  BagRecords from(uint64_t at) const { return BagRecords(file_, at, file_.size(), ""); }

  /// version: 200 for format 2.0, 0 when it is no bag; read as rosbag does.
  size_t lengthOfFirstLine(int& version) const {
    constexpr size_t kLongest = 1023;
    char line[kLongest + 1] = {}, name[100];
    int major, minor;
    const auto length = static_cast<size_t>(std::min<uint64_t>(kLongest, file_.size()));
    file_.copy(0, length, line);
    if (std::sscanf(line, "#ROS%99s V%d.%d", name, &major, &minor) != 3) return 0;
    version = static_cast<int>(int64_t{100} * major + minor);
    const void* end = std::memchr(line, '\n', length);
    return end ? static_cast<size_t>(static_cast<const char*>(end) + 1 - line) : length;
  }

  void readConnection(BagRecords& records) {
    const uint64_t begin = records.at();
    const BagFields fields = records.header(BagOperation::kConnection, "a connection");
    known_.insert(records.field<uint32_t>(fields, "conn", begin));
    records.header();
  }

  void readChunkInfo(BagRecords& records) {
    const uint64_t begin = records.at();
    const BagFields fields = records.header(BagOperation::kChunkInfo, "what is in a chunk");
    const auto count = records.field<uint32_t>(fields, "count", begin);
    const auto at = records.field<uint64_t>(fields, "chunk_pos", begin);
    records.number("the length of a list of connections");
    std::set<uint32_t> connections;
    for (uint32_t i = 0; i < count; ++i) {
      connections.insert(records.number("the number of a connection"));
      records.number("a number of messages");
    }
    chunks_.push_back({at, connections.size()});
  }

  /// The indexes behind the chunk, which tell where its messages are.
  void readIndexes(const ChunkInfo& chunk) {
    BagRecords records = from(chunk.at);
    records.header(BagOperation::kChunk, "a chunk");
    records.skip(records.number("the length of a chunk"), chunk.at, "a chunk");
    std::set<uint32_t>& offsets = messages_[chunk.at];
    for (size_t i = 0; i < chunk.indexes; ++i) {
      const uint64_t begin = records.at();
      const BagFields fields = records.header(BagOperation::kIndex, "the index of a chunk");
      const auto connection = records.field<uint32_t>(fields, "conn", begin);
      if (known_.count(connection) == 0)
        records.damaged(begin, "an index of connection " + std::to_string(connection) +
                                   ", which is not in the list of connections");
      const auto count = records.field<uint32_t>(fields, "count", begin);
      records.number("the length of an index");
      for (uint32_t j = 0; j < count; ++j) {
        records.skip(8, begin, "a time");
        offsets.insert(records.number("the position of a message"));
      }
    }
  }

  void checkMessages(uint64_t chunk, const std::set<uint32_t>& offsets) const {
    if (offsets.empty()) return;
    BagRecords records = from(chunk);
    const BagFields fields = records.header(BagOperation::kChunk, "a chunk");
    const uint32_t size = records.number("the length of a chunk");
    if (size > kLargestChunk)
      records.damaged(chunk, "a chunk of " + std::to_string(size) + " bytes, expected at most " +
                                 std::to_string(kLargestChunk));
    const auto compression = fields.find("compression");
    const std::string kind = compression == fields.end() ? "" : compression->second;
    const uint64_t data = records.at();
    if (kind == "none") {
      for (const uint32_t offset : offsets) checkMessage(BagRecords(file_, data + offset, data + size, ""));
    } else if (kind == "bz2" || kind == "lz4") {
      const auto uncompressed = records.field<uint32_t>(fields, "size", chunk);
      const std::string place = " of what is in the chunk at byte " + std::to_string(chunk);
      const ChunkBytes content = decompressed(records, kind, size, uncompressed);
      for (const uint32_t offset : offsets) checkMessage(BagRecords(content, offset, content.size(), place));
    } else {
      records.damaged(chunk, "a chunk of unknown compression '" + kind + "', expected none, bz2 or lz4");
    }
  }

  static ChunkBytes decompressed(BagRecords& records, const std::string& kind, uint32_t size,
                                 uint32_t uncompressed) {
    const uint64_t begin = records.at();
    if (uncompressed > kLargestChunk)
      records.damaged(begin, "a chunk of " + std::to_string(uncompressed) + " bytes, expected at most " +
                                 std::to_string(kLargestChunk));
    std::string bytes = records.take(size, begin, "a chunk");
    try {
      return ChunkBytes(decompressChunk(kind, std::move(bytes), uncompressed));
    } catch (const std::exception& error) {
      records.damaged(begin, "a chunk that cannot be decompressed (" + std::string(error.what()) + ")");
    }
  }

  static void checkMessage(BagRecords records) {
    const uint64_t begin = records.at();
    records.header(BagOperation::kMessage, "a message");
    records.skip(records.number("the length of a message"), begin, "a message");
  }

  FileBytes file_;
  std::set<uint32_t> known_;  ///< connections
  std::vector<ChunkInfo> chunks_;
  std::map<uint64_t, std::set<uint32_t>> messages_;  ///< in the chunk at this position
};

}  // namespace

void checkBagStructure(const std::string& path) { Walk(path).run(); }

}  // namespace uav_landing
