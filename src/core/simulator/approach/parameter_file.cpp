#include "uav_landing/simulator/parameter_file.h"

#include "parameters/parameter_sections.h"

namespace uav_landing {

Expected<SimulatorParameters> loadSimulatorParameterFile(const std::string& path) {
  return loadSectionFile<SimulatorParameters>(path);
}

Expected<SimulatorParameters> parseSimulatorParameters(const std::string& yaml_text,
                                                       const std::string& name) {
  return parseSections<SimulatorParameters>(yaml_text, name);
}

}  // namespace uav_landing
