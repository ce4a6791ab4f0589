// Bags of format 1.2, written here by its description (http://wiki.ros.org/Bags/Format/1.2), as rosbag reads
// them still.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bags/bag_message.h"
#include "bags/bag_structure.h"

namespace uav_landing {
namespace {

namespace fs = std::filesystem;

template <class T>
std::string bytesOf(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string lengthAnd(const std::string& bytes) {
  return bytesOf(static_cast<uint32_t>(bytes.size())) + bytes;
}

std::string record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) header += lengthAnd(field);
  return lengthAnd(header) + lengthAnd(data);
}

class OldBagStructure : public ::testing::Test {
 protected:
  const std::string magic_ = "#ROSBAG V1.2\n", topic_ = "/stereo/left/image_raw";
  std::string path_ =
      (fs::temp_directory_path() / ("uav_landing_old_" + std::to_string(getpid()) + ".bag")).string();
  size_t definition_ = 0, message_ = 0, index_ = 0;  ///< where these begin, as written last

  void TearDown() override { fs::remove(path_); }

  static std::string fileHeader(uint64_t index) {
    return record({"op=\x03", "index_pos=" + bytesOf(index)}, std::string(50, ' '));
  }

  /// A bag of one picture. definition: what it calls the topic. time: s, when it was received.
  std::string bag(const std::string& definition, uint32_t time, uint32_t count = 1) {
    sensor_msgs::Image image;
    image.width = 5;
    std::vector<uint8_t> data(ros::serialization::serializationLength(image));
    ros::serialization::OStream stream(data.data(), static_cast<uint32_t>(data.size()));
    ros::serialization::serialize(stream, image);

    std::string bytes = magic_ + fileHeader(0);
    definition_ = bytes.size();
    bytes +=
        record({"op=\x01", "topic=" + definition, std::string("md5=") + ros::message_traits::md5sum(image),
                std::string("type=") + ros::message_traits::datatype(image), "def=none"},
               "");
    message_ = bytes.size();
    bytes +=
        record({"op=\x02", "topic=" + topic_, "time=" + bytesOf(uint64_t{100})}, {data.begin(), data.end()});
    index_ = bytes.size();
    bytes += record({"op=\x04", "topic=" + topic_, "ver=" + bytesOf(uint32_t{0}), "count=" + bytesOf(count)},
                    bytesOf(time) + bytesOf(uint32_t{0}) + bytesOf(uint64_t{definition_}));
    return bytes.replace(magic_.size(), fileHeader(0).size(), fileHeader(index_));
  }

  void save(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  void expectDamage(const std::string& bytes, size_t at, const std::string& text) const {
    save(bytes);
    try {
      checkBagStructure(path_);
      FAIL() << "was accepted";
    } catch (const std::exception& error) {
      const std::string found = error.what();
      EXPECT_EQ(found.rfind("damaged at byte " + std::to_string(at) + ": ", 0), 0u)
          << found << "\nexpected " << at;
      EXPECT_NE(found.find(text), std::string::npos) << found;
    }
  }
};

TEST_F(OldBagStructure, IsRightInWhatRosbagReads) {
  save(bag(topic_, 100));
  EXPECT_NO_THROW(checkBagStructure(path_));
  rosbag::Bag opened(path_, rosbag::bagmode::Read);
  rosbag::View view(opened);
  ASSERT_EQ(view.size(), 1u);
  const auto image = readMessage<sensor_msgs::Image>(*view.begin());
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 5u);
}

TEST_F(OldBagStructure, RefusesHeadersAndFieldsThatDoNotFit) {
  const std::string intact = bag(topic_, 100), huge = bytesOf(uint32_t{0xfffffff0});
  for (const size_t at : {magic_.size(), definition_, message_, index_}) {
    expectDamage(std::string(intact).replace(at, 4, huge), at,
                 "a header of 4294967280 bytes, expected at most ");
    expectDamage(std::string(intact).replace(at + 4, 4, huge), at,
                 "a header with a field of 4294967280 bytes");
  }
}

TEST_F(OldBagStructure, RefusesATopicWithoutMessagesForWhichRosbagTakesTheFirstOfNone) {
  std::string bytes = bag(topic_, 0);
  expectDamage(bytes, index_, "without messages");
  bytes = bag(topic_, 100, 0);
  expectDamage(bytes, index_, "without messages");
}

TEST_F(OldBagStructure, RefusesTheDefinitionOfAnotherTopicWhichWouldLeaveThisOneWithoutAny) {
  const std::string bytes = bag("/another", 100);
  expectDamage(bytes, definition_, "expected " + topic_);
}

TEST_F(OldBagStructure, RefusesAFileThatIsCutOff) {
  const std::string intact = bag(topic_, 100);
  for (size_t size = index_ + 1; size < intact.size(); ++size) {
    save(intact.substr(0, size));
    EXPECT_THROW(checkBagStructure(path_), std::runtime_error) << size;
  }
}

TEST_F(OldBagStructure, LeavesToRosbagWhatHasNoIndex) {
  std::string bytes = bag(topic_, 100);
  save(bytes.replace(magic_.size(), fileHeader(0).size(), fileHeader(0)));
  EXPECT_NO_THROW(checkBagStructure(path_));
}

}  // namespace
}  // namespace uav_landing
