#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace uav_landing {
namespace test {

/// A page of docs/ is what process_bag prints with this option.
inline void expectPage(const std::string& page, const std::string& printed, const std::string& option) {
  std::ifstream file(UAV_LANDING_SOURCE_DIR "/docs/" + page);
  std::ostringstream written;
  written << file.rdbuf();
  EXPECT_EQ(written.str(), printed) << "docs/" << page << " is out of date. Regenerate it:\n"
                                    << "rosrun uav_landing process_bag " << option << " > docs/" << page;
}

}  // namespace test
}  // namespace uav_landing
