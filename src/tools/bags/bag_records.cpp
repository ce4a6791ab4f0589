#include "bags/bag_records.h"

#include <stdexcept>

namespace uav_landing {

BagRecords::BagRecords(const BagBytes& bytes, uint64_t from, uint64_t to, std::string place)
    : bytes_(bytes), at_(from), end_(to), place_(std::move(place)) {
  if (from > to) damaged(from, "expected to be before byte " + std::to_string(to));
}

BagFields BagRecords::header() {
  const uint64_t begin = at_;
  const uint32_t length = number("the length of a header");
  const std::string bytes = take(length, begin, "a header");
  BagFields fields;
  for (size_t at = 0; at < bytes.size();) {
    uint32_t size = 0;
    const size_t left = bytes.size() - at;
    if (left >= sizeof size) std::memcpy(&size, bytes.data() + at, sizeof size);
    if (left < sizeof size || size > left - sizeof size)
      damaged(begin, "a header with a field of " + std::to_string(size) + " bytes, expected at most " +
                         std::to_string(left < sizeof size ? 0 : left - sizeof size));
    at += sizeof size;
    const size_t equals = bytes.find('=', at);
    if (equals >= at + size) damaged(begin, "a header with a field that is not of the form name=value");
    fields[bytes.substr(at, equals - at)] = bytes.substr(equals + 1, at + size - equals - 1);
    at += size;
  }
  return fields;
}

BagFields BagRecords::header(BagOperation operation, const char* name) {
  const uint64_t begin = at_;
  BagFields fields = header();
  const auto found = field<uint8_t>(fields, "op", begin);
  if (found != static_cast<uint8_t>(operation))
    damaged(begin, "a record of kind " + std::to_string(found) + ", expected " + name);
  return fields;
}

uint32_t BagRecords::number(const char* name) {
  uint32_t value = 0;
  need(sizeof value, at_, name);
  bytes_.copy(at_, sizeof value, &value);
  at_ += sizeof value;
  return value;
}

std::string BagRecords::take(uint64_t count, uint64_t begin, const char* name) {
  need(count, begin, name);
  std::string taken(count, '\0');
  bytes_.copy(at_, count, taken.data());
  at_ += count;
  return taken;
}

void BagRecords::skip(uint64_t count, uint64_t begin, const char* name) {
  need(count, begin, name);
  at_ += count;
}

void BagRecords::damaged(uint64_t at, const std::string& what) const {
  throw std::runtime_error("damaged at byte " + std::to_string(at) + place_ + ": " + what);
}

void BagRecords::need(uint64_t count, uint64_t begin, const char* name) const {
  if (count > end_ - at_)
    damaged(begin, std::string(name) + " of " + std::to_string(count) + " bytes, expected at most " +
                       std::to_string(end_ - at_));
}

void BagRecords::copyField(const BagFields& fields, const char* name, uint64_t begin, void* to,
                           size_t size) const {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != size)
    damaged(begin,
            std::string("a header without its field ") + name + " of " + std::to_string(size) + " bytes");
  std::memcpy(to, found->second.data(), size);
}

}  // namespace uav_landing
