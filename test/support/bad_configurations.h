#pragma once

#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace uav_landing {
namespace test {

struct BadConfiguration {
  std::string given, message;
};

/// The rows of the table below a heading of docs/bad_configurations.md.
inline std::vector<BadConfiguration> badConfigurations(const std::string& heading) {
  std::ifstream page(UAV_LANDING_SOURCE_DIR "/docs/bad_configurations.md");
  std::vector<BadConfiguration> rows;
  const std::regex row("\\| `(.*)` \\| `(.*)` \\|");
  bool here = false;
  for (std::string line; std::getline(page, line);) {
    std::smatch cells;
    if (line.rfind("## ", 0) == 0) here = line == "## " + heading;
    if (here && std::regex_match(line, cells, row)) rows.push_back({cells[1], cells[2]});
  }
  if (rows.empty()) throw std::runtime_error("no table below " + heading);
  return rows;
}

}  // namespace test
}  // namespace uav_landing
