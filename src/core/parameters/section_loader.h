#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "parameters/out_of_range.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

/// "; did you mean X?" for the nearest of the names, or "" when none is near.
std::string suggestName(const std::string& word, const std::vector<std::string>& names);

/// Tells where a key belongs that this section does not have: it has moved, or it is in a section that all
/// stages share. "" when that is not known.
std::string whereItBelongs(const std::string& section, const std::string& key);

/// Checks that a node is a map (or empty) with every key once. section: "" for the whole file.
Failure checkMap(const YAML::Node& node, const std::string& section);

/// The visitor (see parameters.h) that reads a parameter struct from one YAML map. Values that the map does
/// not give stay as they are. The first failure is kept. text() is for plain strings.
class SectionLoader {
 public:
  SectionLoader(const YAML::Node& node, std::string section) : node_(node), section_(std::move(section)) {}

  template <class Number>
  void number(const char* name, Number& value, double min, double max, const char* unit, const char*) {
    Number given;
    if (!read(name, std::is_integral<Number>::value ? "a whole number" : "a number", given)) return;
    if (given >= min && given <= max)
      value = given;
    else
      refuse(name, outOfRange(given, min, max, unit));
  }

  void flag(const char* name, bool& value, const char*) { read(name, "true or false", value); }

  void text(const char* name, std::string& value, const char*) { read(name, "a word", value); }

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
      all += std::string(index++ == 0 ? "" : " or ") + candidate;
    }
    refuse(name, "'" + given + "' is not a choice, expected " + all);
  }

  /// The first failure. Keys that no parameter asked for are failures, too.
  Failure finish() const;

 private:
  /// True when the section gives this parameter and its type is right.
  template <class T>
  bool read(const char* name, const char* type, T& value) {
    names_.emplace_back(name);
    if (failure_ || !node_.IsMap()) return false;
    const YAML::Node given = node_[name];
    if (!given) return false;
    if (given.IsScalar() && YAML::convert<T>::decode(given, value)) return true;
    const std::string quoted = given.IsScalar() ? "'" + given.Scalar() + "'"
                               : given.IsNull() ? "nothing"
                                                : "a list or map";
    refuse(name, quoted + " is not " + type);
    return false;
  }

  void refuse(const std::string& name, const std::string& problem) {
    failure_ = {Reason::kInputInvalid, section_ + "/" + name + ": " + problem};
  }

  const YAML::Node node_;  // const: operator[] of another node would add the missing keys
  std::string section_;
  std::vector<std::string> names_;
  Failure failure_;
};

/// Checks a section for parameters that contradict each other. A section that may have some has a check() of
/// its own.
template <class ParameterStruct, class = void>
struct SectionCheck {
  static Failure of(const ParameterStruct&) { return {}; }
};
template <class ParameterStruct>
struct SectionCheck<ParameterStruct, std::void_t<decltype(std::declval<const ParameterStruct&>().check())>> {
  static Failure of(const ParameterStruct& parameters) { return parameters.check(); }
};

/// Reads the values of one section into a parameter struct; defaults stay where nothing is given. A failure
/// names the parameter with its section, the value and what was expected. In case of a failure the parameters
/// stay as they were. The following values are refused:
/// - a key that does not exist; the message has the nearest name that does, or where the key belongs;
/// - a value of another type, out of range, or not one of the choices;
/// - a value that contradicts another one.
template <class ParameterStruct>
Failure loadSection(const YAML::Node& node, const std::string& section, ParameterStruct& parameters) {
  const Failure failure = checkMap(node, section);
  if (failure) return failure;
  ParameterStruct loaded = parameters;
  SectionLoader loader(node, section);
  loaded.visit(loader);
  Failure wrong = loader.finish();
  if (!wrong) wrong = SectionCheck<ParameterStruct>::of(loaded);
  if (!wrong) parameters = loaded;
  return wrong;
}

}  // namespace uav_landing
