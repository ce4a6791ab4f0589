#pragma once

#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Reads config/simulator/*.yaml: a map of sections (see SimulatorParameters). A failure begins with the path
/// and names the section and the parameter.
Expected<SimulatorParameters> loadSimulatorParameterFile(const std::string& path);
Expected<SimulatorParameters> parseSimulatorParameters(const std::string& yaml_text, const std::string& name);

}  // namespace uav_landing
