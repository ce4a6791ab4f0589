#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "bags/bag_bytes.h"

namespace uav_landing {

/// Kinds of records, as the field "op" says.
enum class BagOperation : uint8_t {
  kDefinition = 0x01,  // of a topic; format 1.2
  kMessage = 0x02,
  kFileHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

/// A header's fields, values by names.
using BagFields = std::map<std::string, std::string>;

/// Takes records of a bag from bytes, one after another. What does not fit into the bytes ends in a
/// std::runtime_error that says where it is and what was expected.
class BagRecords {
 public:
  /// place: what the positions are counted in, as text behind them; "" the file. bytes must outlive this.
  BagRecords(const BagBytes& bytes, uint64_t from, uint64_t to, std::string place);

  uint64_t at() const { return at_; }

  /// The record's header: fields "name=value", each behind its length, all behind their length.
  BagFields header();
  /// The header of a record of this kind; name: for people.
  BagFields header(BagOperation operation, const char* name);

  /// A number in the header that began there.
  template <class T>
  T field(const BagFields& fields, const char* name, uint64_t begin) const {
    T value{};
    copyField(fields, name, begin, &value, sizeof value);
    return value;
  }

  /// The next four bytes. name: what they are, for people.
  uint32_t number(const char* name);
  /// The next bytes of what began there.
  std::string take(uint64_t count, uint64_t begin, const char* name);
  void skip(uint64_t count, uint64_t begin, const char* name);

  [[noreturn]] void damaged(uint64_t at, const std::string& what) const;

 private:
  void need(uint64_t count, uint64_t begin, const char* name) const;
  void copyField(const BagFields& fields, const char* name, uint64_t begin, void* to, size_t size) const;

  const BagBytes& bytes_;
  uint64_t at_, end_;
  std::string place_;
};

}  // namespace uav_landing
