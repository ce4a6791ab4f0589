#pragma once

#include <string>

namespace uav_landing {

/// Text of docs/node_parameters.md: the private parameters that are in no config file.
std::string nodeParameterTable();

}  // namespace uav_landing
