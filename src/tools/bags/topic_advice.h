#pragma once

#include <map>
#include <string>

namespace uav_landing {

/// Advice for a recording whose topics have other names: --camera, or the complete command of
/// convert_recording. topics: the name, with a slash in front, and the type of each. bag: its path. Each line
/// begins with a line break; "" when there are no images.
std::string topicAdvice(const std::map<std::string, std::string>& topics, const std::string& bag);

}  // namespace uav_landing
