#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace uav_landing {
namespace test {

/// Folder with the dataset folders: environment variable UAV_LANDING_DATA, or shared/data beside the project.
inline std::filesystem::path dataFolder() {
  const char* from_environment = std::getenv("UAV_LANDING_DATA");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  return std::filesystem::path(UAV_LANDING_SOURCE_DIR) / "../shared/data";
}

/// Folder of a dataset ("lab"), or an empty path when it is not on this machine.
inline std::filesystem::path findDataset(const std::string& name) {
  const std::filesystem::path folder = dataFolder() / name;
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

}  // namespace test
}  // namespace uav_landing

/// Declares `variable` as the folder of a dataset; skips the test, saying so, when it is not on this machine.
#define UAV_LANDING_DATASET(variable, name)                                                        \
  const std::filesystem::path variable = ::uav_landing::test::findDataset(name);                   \
  if (variable.empty())                                                                            \
  GTEST_SKIP() << "no dataset " << (::uav_landing::test::dataFolder() / (name)).lexically_normal() \
               << " (set UAV_LANDING_DATA)"
