#pragma once

#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Reads a config file: a map of sections (see Parameters). The failure begins with the path. Files that it
/// names relative to its own folder have their full path then.
Expected<Parameters> loadParameterFile(const std::string& path);
Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name);

/// Gives the files that the parameters name relative to this config file their full path.
void resolveFiles(const std::string& config_file, RigParameters& parameters);

/// Markdown table of all parameters with defaults, ranges, units and meanings (docs/parameters.md).
std::string parameterTable();

}  // namespace uav_landing
