#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "bags/bag_bytes.h"

namespace uav_landing {

/// Kinds of records, by the field "op".
enum class BagOperation : uint8_t {
  kMessage = 0x02,
  kFileHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

/// The fields of a header: values by names.
using BagFields = std::map<std::string, std::string>;

/// Reads the records of a bag from bytes, one after another. Something that does not fit into the bytes
/// causes a std::runtime_error that says where it is and what was expected.
class BagRecords {
 public:
  /// place: text behind positions, which says what they are counted in; "": the file. bytes must outlive this
  /// object.
  BagRecords(const BagBytes& bytes, uint64_t from, uint64_t to, std::string place);

  uint64_t at() const { return at_; }

  /// The record's header: fields "name=value", each after its length, all after their total length.
  BagFields header();
  /// The header of a record of this kind. name: for people.
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
  /// The next bytes of the record that began there.
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
