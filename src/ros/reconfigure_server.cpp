#include "reconfigure_server.h"

#include <algorithm>
#include <vector>

#include "parameters/out_of_range.h"

namespace uav_landing {
namespace {

template <class Parameter, class Value>
void append(std::vector<Parameter>& list, const char* name, const Value& value) {
  Parameter parameter;
  parameter.name = name;
  parameter.value = value;
  list.push_back(parameter);
}

/// The value that the list gives for a name, or null.
template <class Parameter>
const Parameter* find(const std::vector<Parameter>& list, const char* name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& p) { return p.name == name; });
  return found == list.end() ? nullptr : &*found;
}

dynamic_reconfigure::GroupState wholeGroup() {
  dynamic_reconfigure::GroupState group;
  group.name = "Default";
  group.state = 1;
  return group;
}

std::string withUnit(const char* meaning, const char* unit) {
  return *unit == '\0' ? meaning : std::string(meaning) + " (" + unit + ")";
}

}  // namespace

void ReconfigureDescription::add(const char* name, const char* type, const std::string& meaning) {
  if (description_.groups.empty()) {
    description_.groups.emplace_back();
    description_.groups[0].name = "Default";
    for (auto* config : {&description_.dflt, &description_.min, &description_.max})
      config->groups.push_back(wholeGroup());
  }
  dynamic_reconfigure::ParamDescription parameter;
  parameter.name = name;
  parameter.type = type;
  parameter.description = meaning;
  description_.groups[0].parameters.push_back(parameter);
}

void ReconfigureDescription::number(const char* name, double value, double min, double max, const char* unit,
                                    const char* meaning) {
  add(name, "double", withUnit(meaning, unit));
  append(description_.dflt.doubles, name, value);
  append(description_.min.doubles, name, min);
  append(description_.max.doubles, name, max);
}

void ReconfigureDescription::number(const char* name, int value, int min, int max, const char* unit,
                                    const char* meaning) {
  add(name, "int", withUnit(meaning, unit));
  append(description_.dflt.ints, name, value);
  append(description_.min.ints, name, min);
  append(description_.max.ints, name, max);
}

void ReconfigureDescription::flag(const char* name, bool value, const char* meaning) {
  add(name, "bool", meaning);
  append(description_.dflt.bools, name, value);
  append(description_.min.bools, name, false);
  append(description_.max.bools, name, true);
}

void ReconfigureDescription::text(const char* name, const std::string& value, const char* meaning) {
  add(name, "str", meaning);
  append(description_.dflt.strs, name, value);
  append(description_.min.strs, name, std::string());
  append(description_.max.strs, name, std::string());
}

template <class Value>
Value ReconfigureRequestReader::inRange(const char* name, Value given, Value min, Value max,
                                        const char* unit) const {
  const Value used = std::clamp(given, min, max);
  if (used != given)
    ROS_WARN_STREAM(node_ << ": " << name << ": " << outOfRange(given, min, max, unit) << "; " << used
                          << " is used");
  return used;
}

void ReconfigureRequestReader::number(const char* name, double& value, double min, double max,
                                      const char* unit, const char*) {
  const auto* given = find(request_.doubles, name);
  if (given != nullptr && given->value == given->value) value = inRange(name, given->value, min, max, unit);
}

void ReconfigureRequestReader::number(const char* name, int& value, int min, int max, const char* unit,
                                      const char*) {
  if (const auto* given = find(request_.ints, name)) value = inRange(name, given->value, min, max, unit);
}

void ReconfigureRequestReader::flag(const char* name, bool& value, const char*) {
  if (const auto* given = find(request_.bools, name)) value = given->value;
}

void ReconfigureRequestReader::text(const char* name, std::string& value, const char*) {
  if (const auto* given = find(request_.strs, name)) value = given->value;
}

}  // namespace uav_landing
