#pragma once

#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/parameters.h"

namespace YAML {
class Node;
}

namespace uav_landing {

/// Reads one section's values into a parameter struct (defaults stay where nothing is given). The failure
/// names the parameter with its section, the value and what was expected: a key that does not exist (with
/// the nearest name that does), a value of another type, out of range, or not one of the choices.
template <class ParameterStruct>
Failure loadSection(const YAML::Node& node, const std::string& section, ParameterStruct& parameters);

/// Reads a config file: a map of sections (see Parameters). The failure begins with the path.
Expected<Parameters> loadParameterFile(const std::string& path);
Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name);

/// Markdown table of all parameters with defaults, ranges, units and meanings (docs/parameters.md).
std::string parameterTable();

}  // namespace uav_landing
