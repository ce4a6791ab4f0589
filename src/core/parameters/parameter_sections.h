#pragma once

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "parameters/section_loader.h"
#include "uav_landing/base/failure.h"

namespace uav_landing {

// Loads any set of parameter structs, such as Parameters. The set is a struct whose visitSections() names its
// sections.

template <class ParameterSet>
Failure loadSections(const YAML::Node& root, ParameterSet& parameters) {
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
      return {Reason::kInputInvalid, key + ": no such section" + suggestName(key, sections)};
  }
  return {};
}

/// name: what the message of a failure begins with.
template <class ParameterSet>
Expected<ParameterSet> parseSections(const std::string& yaml_text, const std::string& name) {
  ParameterSet parameters;
  Failure failure;
  try {
    failure = loadSections(YAML::Load(yaml_text), parameters);
  } catch (const YAML::Exception& error) {
    failure = {Reason::kInputInvalid, error.what()};
  }
  if (failure) return tl::make_unexpected(Failure{Reason::kInputInvalid, name + ": " + failure.detail});
  return parameters;
}

template <class ParameterSet>
Expected<ParameterSet> loadSectionFile(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none))
    return tl::make_unexpected(Failure{Reason::kInputInvalid, path + ": no such file"});
  std::ifstream file(path);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf() || file.eof()) || file.bad())
    return tl::make_unexpected(Failure{Reason::kInputInvalid, path + ": cannot be read"});
  return parseSections<ParameterSet>(content.str(), path);
}

}  // namespace uav_landing
