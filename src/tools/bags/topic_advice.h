#pragma once

#include <map>
#include <string>

namespace uav_landing {

/// What takes a recording whose topics have other names: --camera, or the complete command of
/// convert_recording. topics: the name, with a slash in front, and type of each. bag: its path. Each line
/// begins with a line break; "" where there are no images.
std::string topicAdvice(const std::map<std::string, std::string>& topics, const std::string& bag);

}  // namespace uav_landing
