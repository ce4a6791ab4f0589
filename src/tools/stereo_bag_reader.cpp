#include "stereo_bag_reader.h"

#include <rosbag/view.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

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
  if (const auto read = message.instantiate<std::remove_const_t<Message>>()) pairing.add<kInput>(read);
}

}  // namespace

StereoBagReader::StereoBagReader(const std::string& path, const std::string& camera) {
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error(path + ": no such file");
  try {
    bag_.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(path + ": cannot be read as a bag (" + error.what() +
                             "); if it was cut off, try `rosbag reindex`");
  }
  const std::string prefix = "/" + camera + "/";
  topics_ = {prefix + "left/image_raw", prefix + "left/camera_info", prefix + "right/image_raw",
             prefix + "right/camera_info"};
}

Failure StereoBagReader::checkTopics() const {
  const std::map<std::string, std::string> found = topicsAndTypes(bag_);
  std::ostringstream problems;
  for (size_t i = 0; i < topics_.size(); ++i) {
    const auto topic = found.find(topics_[i]);
    if (topic == found.end()) {
      problems << "no topic " << topics_[i] << " (" << kTypes[i] << ")\n";
    } else if (topic->second != kTypes[i]) {
      problems << "topic " << topics_[i] << " is " << topic->second << ", expected " << kTypes[i] << '\n';
    }
  }
  if (problems.str().empty()) return {};
  problems << (found.empty() ? "The bag is empty" : "The bag contains:");
  for (const auto& [topic, type] : found) problems << "\n  " << topic << " (" << type << ")";
  return {Reason::kInputInvalid, problems.str()};
}

std::size_t StereoBagReader::leftImages() const {
  return rosbag::View(bag_, rosbag::TopicQuery(topics_[0])).size();
}

std::size_t StereoBagReader::messages() const {
  return rosbag::View(bag_, rosbag::TopicQuery(std::vector<std::string>(topics_.begin(), topics_.end())))
      .size();
}

void StereoBagReader::read(StereoPairing& pairing, const std::function<void()>& progress) const {
  rosbag::View view(bag_, rosbag::TopicQuery(std::vector<std::string>(topics_.begin(), topics_.end())));
  for (const rosbag::MessageInstance& message : view) {
    const std::string topic = message.getTopic();
    if (topic == topics_[0]) {
      add<0>(pairing, message);
    } else if (topic == topics_[1]) {
      add<1>(pairing, message);
    } else if (topic == topics_[2]) {
      add<2>(pairing, message);
    } else {
      add<3>(pairing, message);
    }
    progress();
  }
}

}  // namespace uav_landing
