#include "bags/stereo_bag_reader.h"

#include <rosbag/view.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "bags/bag_message.h"
#include "bags/bag_structure.h"

namespace uav_landing {
namespace {

constexpr std::array<const char*, 4> kTypes = {"sensor_msgs/Image", "sensor_msgs/CameraInfo",
                                               "sensor_msgs/Image", "sensor_msgs/CameraInfo"};

std::map<std::string, std::string> topicsAndTypes(const rosbag::Bag& bag) {
  rosbag::View view(bag);
  std::map<std::string, std::string> found;
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    found[connection->topic] = connection->datatype;
  return found;
}

template <size_t kInput>
void add(StereoPairing& pairing, const rosbag::MessageInstance& message) {
  using Message = typename StereoPairing::Pointer<kInput>::element_type;
  // A message of another version of the type cannot be read; it is as good as missing.
  if (const auto read = readMessage<std::remove_const_t<Message>>(message)) pairing.add<kInput>(read);
}

}  // namespace

StereoBagReader::StereoBagReader(const std::string& path, const std::string& camera, const std::string& imu)
    : imu_(imu) {
  if (std::filesystem::is_directory(path))
    throw std::runtime_error(path +
                             ": is a folder, expected a bag: scripts/process_bags takes folders of bags, "
                             "dataset_to_bag and convert_recording make a bag of images");
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": no such file");
  try {
    checkBagStructure(path);
    bag_.emplace(path, rosbag::bagmode::Read);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot be read as a bag (" + error.what() +
                             "); if it was cut off, try `rosbag reindex`");
  }
  const std::string prefix = "/" + camera + "/";
  topics_ = {prefix + "left/image_raw", prefix + "left/camera_info", prefix + "right/image_raw",
             prefix + "right/camera_info"};
}

Failure StereoBagReader::checkTopics(bool imu_needed) const {
  constexpr char kImuType[] = "sensor_msgs/Imu";
  const std::map<std::string, std::string> found = topicsAndTypes(*bag_);
  std::ostringstream problems;
  bool camera_missing = false;
  for (size_t i = 0; i < topics_.size(); ++i) {
    const auto topic = found.find(topics_[i]);
    if (topic == found.end()) {
      problems << "no topic " << topics_[i] << " (" << kTypes[i] << ")\n";
      camera_missing = true;
    } else if (topic->second != kTypes[i]) {
      problems << "topic " << topics_[i] << " is " << topic->second << ", expected " << kTypes[i] << '\n';
    }
  }
  const auto imu = found.find(imu_);
  if (imu == found.end()) {
    if (imu_needed) problems << "no topic " << imu_ << " (" << kImuType << ")\n";
  } else if (imu->second != kImuType) {
    problems << "topic " << imu_ << " is " << imu->second << ", expected " << kImuType << '\n';
  }
  if (problems.str().empty()) return {};
  problems << (found.empty() ? "The bag is empty" : "The bag contains:");
  for (const auto& [topic, type] : found) problems << "\n  " << topic << " (" << type << ")";
  if (camera_missing) problems << "\n--camera NAME names another namespace";
  return {Reason::kInputInvalid, problems.str()};
}

bool StereoBagReader::hasImu() const {
  return !imu_.empty() && rosbag::View(*bag_, rosbag::TopicQuery(imu_)).size() > 0;
}

std::size_t StereoBagReader::leftImages() const {
  return rosbag::View(*bag_, rosbag::TopicQuery(topics_[0])).size();
}

std::size_t StereoBagReader::messages() const {
  return rosbag::View(*bag_, rosbag::TopicQuery(wanted())).size();
}

std::vector<std::string> StereoBagReader::wanted() const {
  std::vector<std::string> topics(topics_.begin(), topics_.end());
  if (!imu_.empty()) topics.push_back(imu_);
  return topics;
}

void StereoBagReader::readStaticTransforms(
    const std::function<void(const tf2_msgs::TFMessage&)>& visit) const {
  rosbag::View view(*bag_, rosbag::TopicQuery("/tf_static"));
  for (const rosbag::MessageInstance& message : view)
    if (const auto transforms = readMessage<tf2_msgs::TFMessage>(message)) visit(*transforms);
}

void StereoBagReader::read(StereoPairing& pairing, const std::function<void(const sensor_msgs::Imu&)>& imu,
                           const std::function<void()>& progress) const {
  rosbag::View view(*bag_, rosbag::TopicQuery(wanted()));
  for (const rosbag::MessageInstance& message : view) {
    const std::string topic = message.getTopic();
    if (topic == topics_[0]) {
      add<0>(pairing, message);
    } else if (topic == topics_[1]) {
      add<1>(pairing, message);
    } else if (topic == topics_[2]) {
      add<2>(pairing, message);
    } else if (topic == topics_[3]) {
      add<3>(pairing, message);
    } else if (const auto sample = readMessage<sensor_msgs::Imu>(message)) {
      imu(*sample);
    }
    progress();
  }
}

}  // namespace uav_landing
