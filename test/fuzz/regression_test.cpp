// What the fuzzers have found, and a few inputs at random, through the harnesses as built for everybody.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz/harnesses.h"

namespace uav_landing {
namespace fuzz {
namespace {

namespace fs = std::filesystem;
const fs::path kFindings = fs::path(UAV_LANDING_SOURCE_DIR) / "test/fuzz/findings";

class Fuzz : public ::testing::TestWithParam<NamedHarness> {};

TEST_P(Fuzz, SurvivesWhatWasFound) {
  const fs::path folder = kFindings / GetParam().name;
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    GetParam().run(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  }
}

TEST_P(Fuzz, SurvivesAnything) {
  const bool slow = std::string(GetParam().name) == "image_pair";
  std::mt19937 random(1);
  for (int i = 0; i < (slow ? 10 : 300); ++i) {
    std::vector<uint8_t> bytes(random() % 2000);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    GetParam().run(bytes.data(), bytes.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Harness, Fuzz, ::testing::ValuesIn(harnesses()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Fuzz, EveryFolderOfFindingsBelongsToAHarness) {
  for (const auto& entry : fs::directory_iterator(kFindings)) {
    if (!entry.is_directory()) continue;
    bool known = false;
    for (const NamedHarness& harness : harnesses()) known = known || entry.path().filename() == harness.name;
    EXPECT_TRUE(known) << entry.path();
  }
}

}  // namespace
}  // namespace fuzz
}  // namespace uav_landing
