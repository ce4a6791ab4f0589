#include "uav_landing/parameters/parameter_file.h"

#include <sstream>

#include "base/text.h"
#include "parameters/parameter_sections.h"
#include "uav_landing/parameters/table_writer.h"

namespace uav_landing {
namespace {

/// Refuses sections that contradict each other. name: of the file.
Expected<Parameters> agreeing(Expected<Parameters> parameters, const std::string& name) {
  if (!parameters) return parameters;
  const double seen = parameters->approach_angle.runway_width,
               known = parameters->kalman_height.known_runway_width;
  if (seen <= 0 || known <= 0 || seen == known) return parameters;
  return tl::make_unexpected(
      Failure{Reason::kInputInvalid,
              text(name, ": approach_angle/runway_width is ", seen,
                   " m and kalman_height/known_runway_width ", known, " m, expected the same")});
}

}  // namespace

template Failure loadSection(const YAML::Node&, const std::string&, RigParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, RectifyParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, StereoDepthParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, ApproachAngleParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, KalmanHeightParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, OverlayParameters&);

Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name) {
  return agreeing(parseSections<Parameters>(yaml_text, name), name);
}

Expected<Parameters> loadParameterFile(const std::string& path) {
  return agreeing(loadSectionFile<Parameters>(path), path);
}

std::string parameterTable() {
  std::ostringstream out;
  out << "# Parameters\n\nAll parameters of the chain, section by section as in `config/stereo.yaml`. "
         "All stages share `rig`; the other\nsections belong to the nodelet of their name.\n";
  Parameters parameters;
  parameters.visitSections(
      [&](const char* section, auto& values) { values.visit(TableWriter(out, section)); });
  return out.str();
}

}  // namespace uav_landing
