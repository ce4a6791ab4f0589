#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "uav_landing/parameter_file.h"

namespace uav_landing {
namespace {

TEST(ParametersPage, IsWhatTheParameterStructsSay) {
  const std::string expected = parameterTable();
  std::ifstream file(std::filesystem::path(UAV_LANDING_SOURCE_DIR) / "docs/parameters.md");
  std::stringstream page;
  page << file.rdbuf();
  if (page.str() != expected) std::ofstream("parameters.md") << expected;
  EXPECT_EQ(page.str(), expected) << "out of date: cp build/parameters.md docs/parameters.md";
}

}  // namespace
}  // namespace uav_landing
