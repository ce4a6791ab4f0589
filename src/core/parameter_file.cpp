#include "uav_landing/parameter_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>

#include "text.h"
#include "uav_landing/section_loader.h"

namespace uav_landing {
namespace {

template <class... Parts>
Failure invalid(const Parts&... parts) {
  return {Reason::kInputInvalid, text(parts...)};
}

/// Checks that a node is a map (or empty) with every key once. section: "" for the whole file.
Failure checkMap(const YAML::Node& node, const std::string& section) {
  if (node.IsNull()) return {};
  if (!node.IsMap())
    return invalid(section, section.empty() ? "" : ": ", "expected a map of names and values");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar())
      return invalid(section, section.empty() ? "" : ": ", "a name is not a plain word");
    if (!seen.insert(entry.first.Scalar()).second)
      return invalid(section, section.empty() ? "" : "/", entry.first.Scalar(), ": is given twice");
  }
  return {};
}

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

Failure loadSections(const YAML::Node& root, Parameters& parameters) {
  Failure failure = checkMap(root, "");
  if (failure || root.IsNull()) return failure;
  std::vector<std::string> sections;
  parameters.visitSections([&](const char* section, auto& values) {
    sections.emplace_back(section);
    if (!failure && root[section]) failure = loadSection(root[section], section, values);
  });
  if (failure) return failure;
  for (const auto& entry : root) {
    const std::string key = entry.first.Scalar();
    if (std::find(sections.begin(), sections.end(), key) == sections.end())
      return invalid(key, ": no such section", suggestName(key, sections));
  }
  return {};
}

}  // namespace

template <class ParameterStruct>
Failure loadSection(const YAML::Node& node, const std::string& section, ParameterStruct& parameters) {
  const Failure failure = checkMap(node, section);
  if (failure) return failure;
  ParameterStruct loaded = parameters;
  SectionLoader loader(node, section);
  loaded.visit(loader);
  const Failure wrong = loader.finish();
  if (!wrong) parameters = loaded;
  return wrong;
}

template Failure loadSection(const YAML::Node&, const std::string&, RectifyParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, StereoDepthParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, ApproachAngleParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, KalmanHeightParameters&);
template Failure loadSection(const YAML::Node&, const std::string&, OverlayParameters&);

Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name) {
  Parameters parameters;
  Failure failure;
  try {
    failure = loadSections(YAML::Load(yaml_text), parameters);
  } catch (const YAML::Exception& error) {
    failure = invalid(error.what());
  }
  if (failure) return tl::unexpected<Failure>(invalid(name, ": ", failure.detail));
  return parameters;
}

Expected<Parameters> loadParameterFile(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf() || file.eof()) || file.bad())
    return tl::unexpected<Failure>(invalid(path, ": cannot be read"));
  return parseParameters(content.str(), path);
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
