// What is refused before rosbag reads it. The bags are rosbag's own, with single bytes changed; where these
// are follows from the format, whose header fields are in alphabetical order, each behind a length of 4
// bytes.
#include "bags/bag_structure.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bags/bag_message.h"
#include "bags/stereo_bag_reader.h"

namespace uav_landing {
namespace {

namespace fs = std::filesystem;
using rosbag::CompressionType;
namespace compression = rosbag::compression;

constexpr int kMessages = 3;
constexpr uint32_t kHuge = 0xfffffff0;

template <class T>
T numberAt(const std::string& bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

class BagStructure : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ =
        (fs::temp_directory_path() / ("uav_landing_" + name + std::to_string(getpid()) + ".bag")).string();
    write(compression::Uncompressed);
  }
  void TearDown() override { fs::remove(path_); }

  void write(CompressionType compression) {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.setCompression(compression);
    sensor_msgs::Image image;
    image.data.assign(500, 7);
    for (int i = 0; i < kMessages; ++i) bag.write("/stereo/left/image_raw", ros::Time(100 + i), image);
    bag.close();
    std::ifstream file(path_, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
  }

  /// Where the first (last) record of this kind begins: as far before its field "op" as the fields before
  /// that take, and the length of the header.
  size_t recordAt(char operation, size_t fields_before, bool last = false) const {
    const std::string op = std::string("\x04\0\0\0op=", 7) + operation;
    const size_t at = last ? bytes_.rfind(op) : bytes_.find(op);
    EXPECT_NE(at, std::string::npos);
    return at - fields_before - 4;
  }
  size_t fileHeader() const { return std::string("#ROSBAG V2.0\n").size(); }
  size_t chunk() const { return recordAt('\x05', 4 + std::strlen("compression=none")); }
  size_t message() const { return recordAt('\x02', 4 + std::strlen("conn=1234")); }
  size_t index() const { return recordAt('\x04', 8 + std::strlen("conn=1234count=1234")); }
  size_t connection() const { return recordAt('\x07', 4 + std::strlen("conn=1234"), true); }
  size_t chunkInfo() const {
    return recordAt('\x06', 12 + std::strlen("chunk_pos=12345678count=1234end_time=12345678"));
  }
  /// What follows the header of the record there: the length of its data.
  size_t dataLength(size_t record) const { return record + 4 + numberAt<uint32_t>(bytes_, record); }

  template <class T>
  void put(size_t at, T value) {
    std::memcpy(&bytes_[at], &value, sizeof value);
  }

  std::string complaint() {
    std::ofstream(path_, std::ios::binary) << bytes_;
    try {
      checkBagStructure(path_);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  void expectDamage(size_t at, const std::string& text) {
    const std::string found = complaint();
    EXPECT_EQ(found.rfind("damaged at byte " + std::to_string(at), 0), 0u)
        << found << "\nexpected byte " << at;
    EXPECT_NE(found.find(text), std::string::npos) << found;
  }

  std::string path_, bytes_;
};

TEST_F(BagStructure, IsRightInWhatRosbagWrites) {
  for (const CompressionType compression : {compression::Uncompressed, compression::BZ2, compression::LZ4}) {
    write(compression);
    EXPECT_EQ(complaint(), "") << compression;
  }
}

TEST_F(BagStructure, SaysHowABagOfOldRosIsWrittenAnew) {
  bytes_ = "#ROSBAG V1.2\n";
  EXPECT_NE(complaint().find("rosbag record"), std::string::npos) << complaint();
}

TEST_F(BagStructure, RefusesHeadersThatDoNotFit) {
  const std::string intact = bytes_;
  for (const size_t record : {fileHeader(), chunk(), message(), index(), connection(), chunkInfo()}) {
    bytes_ = intact;
    put(record, kHuge);
    expectDamage(record, "a header of " + std::to_string(kHuge) + " bytes, expected at most ");
  }
}

TEST_F(BagStructure, RefusesFieldsThatDoNotFitIntoTheirHeader) {
  const std::string intact = bytes_;
  for (const size_t record : {fileHeader(), chunk(), message(), index(), connection(), chunkInfo()}) {
    bytes_ = intact;
    put(record + 4, numberAt<uint32_t>(bytes_, record) - 3);  // one more than is left behind its own length
    expectDamage(record, "a header with a field of ");
  }
}

TEST_F(BagStructure, RefusesFieldsWithoutNameOrOfAnotherSize) {
  const size_t begin = message();
  const std::string intact = bytes_;
  bytes_[begin + 4 + 4 + std::strlen("conn")] = '-';
  expectDamage(begin, "not of the form name=value");
  bytes_ = intact;
  bytes_[begin + 4 + 4 + 9 + 4] = 'x';  // "xp=" for "op="
  expectDamage(begin, "without its field op of 1 bytes");
}

TEST_F(BagStructure, RefusesRecordsOfAnotherKind) {
  const std::string intact = bytes_;
  for (const size_t record : {chunk(), message(), index(), connection(), chunkInfo()}) {
    bytes_ = intact;
    bytes_[bytes_.find("op=", record) + 3] = 9;
    expectDamage(record, "a record of kind 9, expected ");
  }
}

TEST_F(BagStructure, RefusesDataThatDoesNotFit) {
  const std::string intact = bytes_;
  put(dataLength(chunk()), kHuge);
  expectDamage(chunk(), "a chunk of " + std::to_string(kHuge) + " bytes");
  bytes_ = intact;
  // Ends one byte behind the chunk if it is the last message of it: the index follows.
  const size_t last = recordAt('\x02', 4 + std::strlen("conn=1234"), true);
  put(dataLength(last), numberAt<uint32_t>(bytes_, dataLength(last)) + 1);
  expectDamage(last, "a message of ");
}

TEST_F(BagStructure, RefusesMessagesThatAreNotInTheirChunk) {
  const size_t first_position = dataLength(index()) + 4 + 8;  // behind the length and a time
  const uint32_t size = numberAt<uint32_t>(bytes_, dataLength(chunk()));
  const size_t data = dataLength(chunk()) + 4;
  put(first_position, size + 1);
  expectDamage(data + size + 1, "expected to be before byte " + std::to_string(data + size));
  put(first_position, size - 2);
  expectDamage(data + size - 2, "the length of a header of 4 bytes, expected at most 2");
}

TEST_F(BagStructure, RefusesPositionsBeyondTheFile) {
  const size_t index_position = bytes_.find("index_pos=") + std::strlen("index_pos=");
  const size_t chunk_position = bytes_.find("chunk_pos=") + std::strlen("chunk_pos=");
  for (const size_t at : {index_position, chunk_position}) {
    const std::string intact = bytes_;
    put(at, uint64_t{1} << 60);
    expectDamage(uint64_t{1} << 60, "expected to be before byte " + std::to_string(bytes_.size()));
    bytes_ = intact;
  }
}

TEST_F(BagStructure, RefusesAnIndexOfAnUnknownConnection) {
  put(index() + 4 + 4 + std::strlen("conn="), uint32_t{77});
  expectDamage(index(), "connection 77, which is not in the list");
}

TEST_F(BagStructure, RefusesMoreMessagesThanAnIndexHolds) {
  put(index() + 4 + 4 + std::strlen("conn=1234") + 4 + std::strlen("count="), kHuge);
  expectDamage(index(), "");
}

TEST_F(BagStructure, RefusesAnUnknownCompressionAndEncryption) {
  bytes_.replace(bytes_.find("compression=none"), 16, "compression=zstd");
  expectDamage(chunk(), "unknown compression 'zstd'");
  write(compression::Uncompressed);
  bytes_.replace(bytes_.find("chunk_count"), 11, "encryptor=A");
  EXPECT_NE(complaint().find("encrypted by A"), std::string::npos);
}

TEST_F(BagStructure, RefusesChunksThatAreDamagedInsideTheirCompression) {
  for (const CompressionType compression : {compression::BZ2, compression::LZ4}) {
    write(compression);
    const size_t record = recordAt('\x05', 4 + std::strlen("compression=bz2"));
    const size_t data = dataLength(record) + 4;
    const std::string intact = bytes_;
    bytes_[data + 20] ^= 1;
    expectDamage(data, "a chunk that cannot be decompressed");
    // A size that is not that of the content: rosbag would take what its buffer held before for the rest of
    // it.
    bytes_ = intact;
    const size_t size = bytes_.find("size=", record) + std::strlen("size=");
    put(size, numberAt<uint32_t>(bytes_, size) + 1);
    expectDamage(data, "a chunk that cannot be decompressed");
    put(size, numberAt<uint32_t>(bytes_, size) - 2);
    expectDamage(data, "a chunk that cannot be decompressed");
    put(size, kHuge);
    expectDamage(data, "a chunk of " + std::to_string(kHuge) + " bytes, expected at most ");
  }
}

TEST_F(BagStructure, RefusesAnLz4BlockThatIsLargerThanItsBuffer) {
  write(compression::LZ4);
  const size_t data = dataLength(recordAt('\x05', 4 + std::strlen("compression=lz4"))) + 4;
  constexpr size_t kFrameHeader = 7;
  put(data + kFrameHeader, (64u << 20));
  expectDamage(data, "no intact lz4 data");
}

TEST_F(BagStructure, RefusesMessagesThatDoNotFitInsideACompressedChunk) {
  rosbag::Bag bag(path_, rosbag::bagmode::Write);
  bag.setCompression(compression::BZ2);
  bag.write("/a", ros::Time(1), sensor_msgs::Image());
  bag.close();
  std::ifstream file(path_, std::ios::binary);
  bytes_.assign(std::istreambuf_iterator<char>(file), {});
  const size_t first_position = dataLength(index()) + 4 + 8;
  put(first_position, numberAt<uint32_t>(bytes_, first_position) + 1);
  const size_t record = recordAt('\x05', 4 + std::strlen("compression=bz2"));
  const std::string found = complaint();
  EXPECT_NE(found.find(" of what is in the chunk at byte " + std::to_string(record)), std::string::npos)
      << found;
}

TEST_F(BagStructure, RefusesAFileThatIsCutOffAnywhere) {
  const std::string intact = bytes_;
  // With an index, but without its end.
  for (size_t size = fileHeader() + 200; size < intact.size(); size += 31) {
    bytes_ = intact.substr(0, size);
    ASSERT_NE(complaint(), "") << size;
  }
}

TEST_F(BagStructure, LeavesToRosbagWhatHasNoIndexOrAnUnknownFormat) {
  const std::string intact = bytes_;
  put(bytes_.find("index_pos=") + std::strlen("index_pos="), uint64_t{0});
  EXPECT_EQ(complaint(), "");
  bytes_ = intact;
  bytes_.replace(0, 13, "#ROSBAG V1.1\n");
  EXPECT_EQ(complaint(), "");
  bytes_ = "height,angle\n";
  EXPECT_EQ(complaint(), "");
  bytes_ = "";
  EXPECT_EQ(complaint(), "");
}

TEST_F(BagStructure, LeavesLengthsInsideMessagesToTheirReaderWhichComparesThemBeforeItTakesMemory) {
  // The picture is the last field of its message and 500 bytes long.
  const size_t begin = dataLength(message()), size = numberAt<uint32_t>(bytes_, begin);
  ASSERT_EQ(numberAt<uint32_t>(bytes_, begin + 4 + size - 504), 500u);
  put(begin + 4 + size - 504, kHuge);
  EXPECT_EQ(complaint(), "");
  rosbag::Bag bag(path_, rosbag::bagmode::Read);
  rosbag::View view(bag);
  EXPECT_THROW(readMessage<sensor_msgs::Image>(*view.begin()), rosbag::BagFormatException);
}

TEST_F(BagStructure, ReadsMessagesAsRosbagDoes) {
  rosbag::Bag bag(path_, rosbag::bagmode::Read);
  rosbag::View view(bag);
  for (const rosbag::MessageInstance& message : view) {
    const auto read = readMessage<sensor_msgs::Image>(message);
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, *message.instantiate<sensor_msgs::Image>());
    EXPECT_FALSE(readMessage<sensor_msgs::CameraInfo>(message));
  }
  EXPECT_EQ(view.size(), static_cast<uint32_t>(kMessages));
}

TEST(MessageBytes, TakesNoMemoryForASequenceThatDoesNotFit) {
  // Three numbers take 24 bytes.
  std::vector<uint8_t> bytes(4 + 23);
  bytes[0] = 3;
  std::vector<double> numbers;
  MessageBytes tooFew(bytes.data(), static_cast<uint32_t>(bytes.size()));
  EXPECT_THROW(tooFew.next(numbers), ros::serialization::StreamOverrunException);
  EXPECT_EQ(numbers.capacity(), 0u);
  bytes.push_back(0);
  MessageBytes enough(bytes.data(), static_cast<uint32_t>(bytes.size()));
  enough.next(numbers);
  EXPECT_EQ(numbers.size(), 3u);
}

TEST_F(BagStructure, IsCheckedByTheReaderOfTheProgramsWhichNamesTheFile) {
  put(message(), kHuge);
  std::ofstream(path_, std::ios::binary) << bytes_;
  try {
    StereoBagReader({path_}, "stereo", "");
    FAIL() << "was read";
  } catch (const std::exception& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path_ + ": cannot be read as a bag (damaged at byte ", 0), 0u)
        << error.what();
  }
}

}  // namespace
}  // namespace uav_landing
