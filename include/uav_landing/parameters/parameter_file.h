#pragma once

#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Reads a config file: a map of sections (see Parameters). The failure begins with the path.
Expected<Parameters> loadParameterFile(const std::string& path);
Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name);

/// Markdown table of all parameters with defaults, ranges, units and meanings (docs/parameters.md).
std::string parameterTable();

}  // namespace uav_landing
