#include "bags/stereo_bag_reader.h"

#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bags/bag_message.h"
#include "bags/bag_structure.h"
#include "bags/topic_advice.h"

namespace uav_landing {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kTypes = {"sensor_msgs/Image", "sensor_msgs/CameraInfo",
                                               "sensor_msgs/Image", "sensor_msgs/CameraInfo"};
constexpr char kActive[] = ".active";

/// Returns the topic with a slash in front.
std::string absolute(const std::string& topic) { return topic.rfind('/', 0) == 0 ? topic : "/" + topic; }

void addTo(rosbag::View& view, const std::vector<std::unique_ptr<rosbag::Bag>>& bags,
           const std::vector<std::string>& topics) {
  for (const auto& bag : bags) view.addQuery(*bag, rosbag::TopicQuery(topics));
}

std::map<std::string, std::string> topicsAndTypes(const std::vector<std::unique_ptr<rosbag::Bag>>& bags) {
  std::map<std::string, std::string> found;
  for (const auto& bag : bags) {
    rosbag::View view(*bag);
    for (const rosbag::ConnectionInfo* connection : view.getConnections())
      found[connection->topic] = connection->datatype;
  }
  return found;
}

/// header.stamp, ns; the header is the first field of all types that are paired.
int64_t stampOf(const rosbag::MessageInstance& message, std::vector<uint8_t>& buffer) {
  buffer.resize(message.size());
  ros::serialization::OStream copy(buffer.data(), static_cast<uint32_t>(buffer.size()));
  message.write(copy);
  uint32_t sequence = 0;
  ros::Time stamp;
  try {
    MessageBytes bytes(buffer.data(), static_cast<uint32_t>(buffer.size()));
    bytes.next(sequence);
    bytes.next(stamp);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw rosbag::BagFormatException("a message of " + message.getTopic() + " has " +
                                     std::to_string(buffer.size()) + " bytes, too few for a header");
  }
  return static_cast<int64_t>(stamp.toNSec());
}

/// Whether its version of the type is ours; another one cannot be read, and counts as missing.
bool isRead(const rosbag::MessageInstance& message, size_t input) {
  return input % 2 == 0 ? message.isType<sensor_msgs::Image>() : message.isType<sensor_msgs::CameraInfo>();
}

std::unique_ptr<rosbag::Bag> openBag(const std::string& path) {
  if (fs::is_directory(path))
    throw std::runtime_error(path +
                             ": is a folder, expected a bag: scripts/process_bags takes folders of bags, "
                             "dataset_to_bag and convert_recording make a bag of images");
  const bool active = fs::path(path).extension() == kActive;
  if (active || (!fs::exists(path) && fs::exists(path + kActive)))
    throw std::runtime_error((active ? path : path + kActive) +
                             ": this recording was never closed (it still runs, or was cut off): when it has "
                             "ended, `rosbag reindex` it, and give it a name without " +
                             kActive);
  if (!fs::is_regular_file(path)) throw std::runtime_error(path + ": no such file");
  try {
    checkBagStructure(path);
    return std::make_unique<rosbag::Bag>(path, rosbag::bagmode::Read);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot be read as a bag (" + error.what() +
                             "); if it was cut off, try `rosbag reindex`");
  }
}

}  // namespace

StereoBagReader::StereoBagReader(const std::vector<std::string>& paths, const std::string& camera,
                                 const std::string& imu)
    : paths_(paths), imu_(imu) {
  for (const std::string& path : paths) bags_.push_back(openBag(path));
  const std::string prefix = "/" + camera + "/";
  topics_ = {prefix + "left/image_raw", prefix + "left/camera_info", prefix + "right/image_raw",
             prefix + "right/camera_info"};
}

Failure StereoBagReader::checkTopics(bool imu_needed) const {
  constexpr char kImuType[] = "sensor_msgs/Imu";
  const std::map<std::string, std::string> recorded = topicsAndTypes(bags_);
  std::map<std::string, std::string> found;
  for (const auto& [topic, type] : recorded) found[absolute(topic)] = type;
  std::ostringstream problems;
  bool camera_missing = false;
  for (size_t i = 0; i < topics_.size(); ++i) {
    const auto topic = found.find(topics_[i]);
    if (topic == found.end()) {
      problems << "no topic " << topics_[i] << " (" << kTypes[i] << ")\n";
      camera_missing = true;
    } else if (topic->second != kTypes[i]) {
      problems << "topic " << topics_[i] << " is " << topic->second << ", expected " << kTypes[i] << '\n';
      camera_missing = true;
    }
  }
  const auto imu = found.find(absolute(imu_));
  if (imu == found.end()) {
    if (imu_needed) problems << "no topic " << imu_ << " (" << kImuType << ")\n";
  } else if (imu->second != kImuType) {
    problems << "topic " << imu_ << " is " << imu->second << ", expected " << kImuType << '\n';
  }
  if (problems.str().empty()) return {};
  problems << (recorded.empty() ? "The bag is empty" : "The bag contains:");
  for (const auto& [topic, type] : recorded) problems << "\n  " << topic << " (" << type << ")";
  if (camera_missing) problems << topicAdvice(found, paths_.front());
  return {Reason::kInputInvalid, problems.str()};
}

bool StereoBagReader::hasImu() const {
  rosbag::View view;
  if (!imu_.empty()) addTo(view, bags_, namesOf(imu_));
  return view.size() > 0;
}

std::size_t StereoBagReader::messages() const {
  rosbag::View view;
  addTo(view, bags_, wanted());
  return view.size();
}

std::vector<std::string> StereoBagReader::namesOf(const std::string& topic) const {
  const std::string name = absolute(topic);
  return {name, name.substr(1)};
}

std::vector<std::string> StereoBagReader::wanted() const {
  std::vector<std::string> topics;
  for (const std::string& topic : topics_)
    for (const std::string& name : namesOf(topic)) topics.push_back(name);
  if (!imu_.empty())
    for (const std::string& name : namesOf(imu_)) topics.push_back(name);
  return topics;
}

void StereoBagReader::readStaticTransforms(
    const std::function<void(const tf2_msgs::TFMessage&)>& visit) const {
  rosbag::View view;
  addTo(view, bags_, namesOf("/tf_static"));
  for (const rosbag::MessageInstance& message : view)
    if (const auto transforms = readMessage<tf2_msgs::TFMessage>(message)) visit(*transforms);
}

PairPlan StereoBagReader::plan(const RectifyParameters& parameters, const std::function<void()>& progress) {
  rosbag::View view;
  addTo(view, bags_, wanted());
  StereoStamps stamps;
  std::vector<uint8_t> buffer;
  std::size_t place = 0;
  for (const rosbag::MessageInstance& message : view) {
    const auto topic = std::find(topics_.begin(), topics_.end(), absolute(message.getTopic()));
    const size_t input = topic - topics_.begin();
    if (topic == topics_.end()) {
      imu_messages_.push_back({message, place});
    } else if (isRead(message, input)) {
      stamps[input].push_back({stampOf(message, buffer), place});
      inputs_[input].push_back({message, place});
    }
    ++place;
    progress();
  }
  return planPairs(stamps, topics_, parameters);
}

void StereoBagReader::read(const PairPlan& plan, const PairVisitor& visit,
                           const std::function<void(const sensor_msgs::Imu&)>& imu) const {
  auto next = imu_messages_.begin();
  const auto imuUpTo = [&](std::size_t place) {
    for (; next != imu_messages_.end() && next->place < place; ++next)
      if (const auto sample = readMessage<sensor_msgs::Imu>(next->message)) imu(*sample);
  };
  // A camera_info that several pairs use is read once and is the same object for all.
  std::array<std::pair<std::size_t, sensor_msgs::CameraInfoConstPtr>, 2> infos;
  const auto info = [&](const PairPlan::Pair& pair, size_t input) {
    auto& [place, message] = infos[input / 2];
    if (!message || place != pair.messages[input]) {
      place = pair.messages[input];
      message = readMessage<sensor_msgs::CameraInfo>(inputs_[input][place].message);
    }
    return message;
  };
  for (const PairPlan::Pair& pair : plan.pairs) {
    imuUpTo(pair.place);
    const sensor_msgs::ImageConstPtr left =
        readMessage<sensor_msgs::Image>(inputs_[0][pair.messages[0]].message);
    const sensor_msgs::ImageConstPtr right =
        readMessage<sensor_msgs::Image>(inputs_[2][pair.messages[2]].message);
    visit(left, info(pair, 1), right, info(pair, 3));
  }
  imuUpTo(SIZE_MAX);
}

}  // namespace uav_landing
