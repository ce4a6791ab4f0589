#include "bags/old_bag_structure.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bags/bag_records.h"

namespace uav_landing {
namespace {

/// Messages of a topic: time of receipt, ns, and position.
using Messages = std::vector<std::pair<uint64_t, uint64_t>>;

BagRecords from(const BagBytes& bag, uint64_t at) { return BagRecords(bag, at, bag.size(), ""); }

void readIndex(BagRecords& list, std::map<std::string, Messages>& topics) {
  const uint64_t begin = list.at();
  const BagFields fields = list.header(BagOperation::kIndex, "the index of a topic");
  const auto topic = fields.find("topic");
  if (topic == fields.end()) list.damaged(begin, "the index of a topic without its name");
  const auto count = list.field<uint32_t>(fields, "count", begin);
  list.number("the length of an index");
  Messages& messages = topics[topic->second];
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t seconds = list.number("a time"), time = seconds * 1000000000 + list.number("a time");
    const uint64_t low = list.number("a position"), high = list.number("a position");
    // rosbag ignores messages without a time.
    if (time != 0) messages.emplace_back(time, low | high << 32);
  }
  if (messages.empty()) list.damaged(begin, "the index of a topic without messages");
}

/// rosbag reads the definition of a topic before its first message, and finds the data of a topic by its
/// name.
void checkDefinition(const BagBytes& bag, const std::string& topic, const Messages& messages) {
  const auto earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
  const uint64_t begin = std::min_element(messages.begin(), messages.end(), earlier)->second;
  BagRecords records = from(bag, begin);
  const BagFields fields = records.header(BagOperation::kDefinition, "the definition of a topic");
  const auto name = fields.find("topic");
  if (name == fields.end() || name->second != topic)
    records.damaged(begin, "the definition of another topic, expected " + topic);
}

void checkMessage(BagRecords records) {
  const uint64_t begin = records.at();
  for (;;) {
    const uint64_t at = records.at();
    const BagFields fields = records.header();
    const uint32_t size = records.number("the length of a message");
    const auto operation = static_cast<BagOperation>(records.field<uint8_t>(fields, "op", at));
    if (operation == BagOperation::kDefinition) continue;  // it has no data
    if (operation != BagOperation::kMessage) records.damaged(begin, "another record, expected a message");
    return records.skip(size, begin, "a message");
  }
}

}  // namespace

void checkOldBagStructure(const BagBytes& bag, uint64_t first_record) {
  BagRecords records = from(bag, first_record);
  const BagFields header = records.header(BagOperation::kFileHeader, "the file header");
  const auto index = records.field<uint64_t>(header, "index_pos", first_record);
  if (index == 0) return;
  records.number("the length of the padding");

  std::map<std::string, Messages> topics;
  for (BagRecords list = from(bag, index); list.at() < bag.size();) readIndex(list, topics);
  for (const auto& [topic, messages] : topics) {
    checkDefinition(bag, topic, messages);
    for (const auto& message : messages) checkMessage(from(bag, message.second));
  }
}

}  // namespace uav_landing
