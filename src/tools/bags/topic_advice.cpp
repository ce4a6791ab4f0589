#include "bags/topic_advice.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

namespace uav_landing {
namespace {

constexpr char kImage[] = "sensor_msgs/Image", kInfo[] = "sensor_msgs/CameraInfo";
constexpr char kRaw[] = "/left/image_raw";

using Topics = std::map<std::string, std::string>;
using Sides = std::pair<std::string, std::string>;  // left and right

bool has(const Topics& topics, const std::string& name, const char* type) {
  const auto topic = topics.find(name);
  return topic != topics.end() && topic->second == type;
}

/// Namespaces, without the slash in front, in which all four topics have the right names and types.
std::vector<std::string> cameras(const Topics& topics) {
  std::vector<std::string> names;
  for (const auto& [topic, type] : topics) {
    const size_t end = topic.size() - std::min(topic.size(), sizeof kRaw - 1);
    if (end < 2 || topic.compare(end, std::string::npos, kRaw) != 0) continue;
    const std::string name = topic.substr(0, end);
    if (has(topics, name + "/left/image_raw", kImage) && has(topics, name + "/right/image_raw", kImage) &&
        has(topics, name + "/left/camera_info", kInfo) && has(topics, name + "/right/camera_info", kInfo))
      names.push_back(name.substr(1));
  }
  return names;
}

/// Possible names of the other camera's topic.
std::vector<std::string> counterparts(const std::string& left) {
  static const std::vector<Sides> words{{"left", "right"},      {"Left", "Right"},
                                        {"cam0", "cam1"},       {"cam_0", "cam_1"},
                                        {"camera0", "camera1"}, {"camera_0", "camera_1"},
                                        {"infra1", "infra2"},   {"fisheye1", "fisheye2"},
                                        {"camera1", "camera2"}, {"camera_1", "camera_2"},
                                        {"cam1", "cam2"},       {"cam_1", "cam_2"},
                                        {"_l/", "_r/"},         {"/l/", "/r/"}};
  std::vector<std::string> names;
  for (const auto& [word, other] : words) {
    std::string name = left;
    size_t at = name.find(word);
    if (at == std::string::npos) continue;
    for (; at != std::string::npos; at = name.find(word, at + other.size()))
      name.replace(at, word.size(), other);
    names.push_back(name);
  }
  return names;
}

/// The topics of two cameras, by their names; else the only two that exist.
std::optional<Sides> imagePair(const std::vector<std::string>& images) {
  for (const std::string& left : images)
    for (const std::string& right : counterparts(left))
      if (std::find(images.begin(), images.end(), right) != images.end()) return Sides{left, right};
  if (images.size() == 2) return Sides{images[0], images[1]};
  return std::nullopt;
}

/// camera_info beside an image topic, as convert_recording uses it.
std::string infoBeside(std::string topic) {
  const std::string compressed = "/compressed";
  if (topic.size() > compressed.size() &&
      topic.compare(topic.size() - compressed.size(), compressed.size(), compressed) == 0)
    topic.resize(topic.size() - compressed.size());
  return topic.substr(0, topic.rfind('/')) + "/camera_info";
}

std::string outputFor(const std::string& bag) {
  const size_t end =
      bag.size() >= 4 && bag.compare(bag.size() - 4, 4, ".bag") == 0 ? bag.size() - 4 : bag.size();
  return bag.substr(0, end) + "_stereo.bag";
}

/// An argument quoted for a shell.
std::string quoted(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 ||
           std::string("/._-+:@~").find(static_cast<char>(letter)) != std::string::npos;
  });
  return plain ? text : "'" + text + "'";
}

std::string calibrationOptions(const Topics& topics, const Sides& images) {
  std::string options;
  for (const auto& [side, image] :
       {std::pair<std::string, std::string>{"left", images.first}, {"right", images.second}})
    if (!has(topics, infoBeside(image), kInfo)) options += " --" + side + "-calibration " + side + ".yaml";
  return options;
}

}  // namespace

std::string topicAdvice(const Topics& topics, const std::string& bag) {
  const std::vector<std::string> names = cameras(topics);
  if (!names.empty()) return "\nIts cameras have another namespace: --camera " + names.front();
  std::vector<std::string> images;
  for (const auto& [topic, type] : topics)
    if (type == kImage || type == "sensor_msgs/CompressedImage") images.push_back(topic);
  if (images.empty()) return "";
  const std::string command = "\n  rosrun uav_landing convert_recording bag " + quoted(bag);
  const std::string output = " --output " + quoted(outputFor(bag));
  if (images.size() == 1)
    return "\nIf " + images.front() +
           " has the images of both cameras side by side, this makes a bag that can be read:" + command +
           " --side-by-side " + images.front() +
           " --left-calibration left.yaml --right-calibration right.yaml" + output;
  const std::optional<Sides> sides = imagePair(images);
  const Sides named = sides.value_or(Sides{"LEFT_TOPIC", "RIGHT_TOPIC"});
  std::string advice = "\nThis makes a bag that can be read" +
                       std::string(sides ? "" : " (fill in the topics of the images)") + ":" + command +
                       " --left " + named.first + " --right " + named.second;
  if (sides) advice += calibrationOptions(topics, *sides);
  return advice + output;
}

}  // namespace uav_landing
