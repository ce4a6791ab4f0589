#include "uav_landing/parameters/parameter_file.h"

#include <initializer_list>
#include <sstream>

#include "base/text.h"
#include "parameters/parameter_sections.h"

namespace uav_landing {
namespace {

/// Writes one row of the parameter table per parameter.
class TableWriter {
 public:
  explicit TableWriter(std::ostream& out) : out_(out) {}

  template <class Number>
  void number(const char* name, Number value, double min, double max, const char* unit, const char* meaning) {
    row(name, text(value), text(min, " to ", max), unit, meaning);
  }
  void flag(const char* name, bool value, const char* meaning) {
    row(name, value ? "true" : "false", "true, false", "", meaning);
  }
  template <class Enum>
  void choice(const char* name, Enum value, std::initializer_list<const char*> choices, const char* meaning) {
    std::string all;
    for (const char* candidate : choices) all += text(all.empty() ? "" : ", ", candidate);
    row(name, choices.begin()[static_cast<int>(value)], all, "", meaning);
  }

 private:
  void row(const char* name, const std::string& value, const std::string& range, const char* unit,
           const char* meaning) {
    out_ << "| `" << name << "` | " << value << " | " << range << " | " << unit << " | " << meaning << " |\n";
  }

  std::ostream& out_;
};

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
  out << "# Parameters\n\nAll parameters of the chain, section by section as in `config/stereo.yaml`.\n";
  Parameters parameters;
  parameters.visitSections([&](const char* section, auto& values) {
    out << "\n## " << section << "\n\n| name | default | range | unit | meaning |\n|---|---|---|---|---|\n";
    values.visit(TableWriter(out));
  });
  return out.str();
}

}  // namespace uav_landing
