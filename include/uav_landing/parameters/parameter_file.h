#pragma once

#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Reads a config file: a map of sections (see Parameters). A failure begins with the path. File names that
/// are relative to the config file's folder become full paths.
Expected<Parameters> loadParameterFile(const std::string& path);
Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name);

/// Turns file names that are relative to this config file's folder into full paths.
void resolveFiles(const std::string& config_file, RigParameters& parameters);

/// Markdown table of all parameters with defaults, ranges, units and meanings (docs/parameters.md).
std::string parameterTable();

}  // namespace uav_landing
