#include "uav_landing/parameter_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <numeric>
#include <set>
#include <sstream>
#include <type_traits>

#include "text.h"

namespace uav_landing {
namespace {

/// Levenshtein distance of two words.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

/// "; did you mean X?" for the nearest of the names, or nothing when none is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const auto nearest = std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return editDistance(word, a) < editDistance(word, b);
  });
  if (nearest == names.end() || 2 * editDistance(word, *nearest) > word.size()) return "";
  return "; did you mean " + *nearest + "?";
}

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

std::string quoted(const YAML::Node& value) {
  return value.IsScalar() ? "'" + value.Scalar() + "'" : value.IsNull() ? "nothing" : "a list or map";
}

/// Takes the values of one section from YAML; the first failure stays.
class Loader {
 public:
  Loader(const YAML::Node& node, std::string section) : node_(node), section_(std::move(section)) {}

  template <class Number>
  void number(const char* name, Number& value, double min, double max, const char* unit, const char*) {
    const char* type = std::is_integral<Number>::value ? "a whole number" : "a number";
    Number given;
    if (!read(name, type, given)) return;
    if (!(given >= min && given <= max)) {  // also true for NaN
      const std::string unit_text = *unit == '\0' ? "" : text(" ", unit);
      failure_ = invalid(section_, "/", name, ": ", given, " is out of range, expected ", min, " to ", max,
                         unit_text);
      return;
    }
    value = given;
  }

  void flag(const char* name, bool& value, const char*) { read(name, "true or false", value); }

  template <class Enum>
  void choice(const char* name, Enum& value, std::initializer_list<const char*> choices, const char*) {
    std::string given, all;
    if (!read(name, "a word", given)) return;
    int index = 0;
    for (const char* candidate : choices) {
      if (given == candidate) {
        value = static_cast<Enum>(index);
        return;
      }
      all += text(index++ == 0 ? "" : " or ", candidate);
    }
    failure_ = invalid(section_, "/", name, ": '", given, "' is not a choice, expected ", all);
  }

  /// The first thing that was wrong, keys that no parameter asked for included.
  Failure finish() const {
    if (failure_ || !node_.IsMap()) return failure_;
    for (const auto& entry : node_) {
      const std::string key = entry.first.Scalar();
      if (std::find(names_.begin(), names_.end(), key) == names_.end())
        return invalid(section_, "/", key, ": no such parameter", suggestion(key, names_));
    }
    return {};
  }

 private:
  /// True when the section gives this parameter and its type is right.
  template <class T>
  bool read(const char* name, const char* type, T& value) {
    names_.emplace_back(name);
    if (failure_ || !node_.IsMap()) return false;
    const YAML::Node given = node_[name];
    if (!given) return false;
    if (!given.IsScalar() || !YAML::convert<T>::decode(given, value)) {
      failure_ = invalid(section_, "/", name, ": ", quoted(given), " is not ", type);
      return false;
    }
    return true;
  }

  const YAML::Node node_;  // const: operator[] of another node would add the missing keys
  std::string section_;
  std::vector<std::string> names_;
  Failure failure_;
};

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
      return invalid(key, ": no such section", suggestion(key, sections));
  }
  return {};
}

}  // namespace

template <class ParameterStruct>
Failure loadSection(const YAML::Node& node, const std::string& section, ParameterStruct& parameters) {
  const Failure failure = checkMap(node, section);
  if (failure) return failure;
  ParameterStruct loaded = parameters;
  Loader loader(node, section);
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
