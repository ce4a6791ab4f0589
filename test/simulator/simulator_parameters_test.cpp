#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <sstream>
#include <string>

#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace {

const std::string kFolder = std::string(UAV_LANDING_SOURCE_DIR) + "/config/simulator/";

std::string failureOf(const std::string& yaml) {
  const Expected<SimulatorParameters> parameters = parseSimulatorParameters(yaml, "my.yaml");
  return parameters ? "" : parameters.error().detail;
}

class ShippedConfigTest : public testing::TestWithParam<const char*> {};

TEST_P(ShippedConfigTest, LoadsAndCanBeFlown) {
  const Expected<SimulatorParameters> parameters = loadSimulatorParameterFile(kFolder + GetParam());
  ASSERT_TRUE(parameters) << parameters.error().detail;
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(*parameters);
  ASSERT_TRUE(simulator) << simulator.error().detail;
  const ApproachSimulator::Frame last = simulator->frame(simulator->frames() - 1);
  EXPECT_GT(last.truth.height, 0.5);
  EXPECT_LT(last.truth.height, 3.5);
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedConfigTest,
                         testing::Values("lab.yaml", "full_scale.yaml", "bent_rig.yaml", "demo.yaml"));

/// Compares a section of the YAML file with the defaults, key by key.
struct DefaultsCheck {
  const YAML::Node& section;
  const std::string name;

  template <class Number>
  void number(const char* key, Number& value, double, double, const char*, const char*) {
    ASSERT_TRUE(section[key]) << name << "/" << key << " is not explained";
    EXPECT_DOUBLE_EQ(section[key].as<double>(), static_cast<double>(value)) << name << "/" << key;
  }
  template <class Enum>
  void choice(const char* key, Enum& value, std::initializer_list<const char*> choices, const char*) {
    ASSERT_TRUE(section[key]) << name << "/" << key << " is not explained";
    EXPECT_EQ(section[key].as<std::string>(), choices.begin()[static_cast<int>(value)]) << name << "/" << key;
  }
};

TEST(SimulatorParameters, FullScaleExplainsEveryParameterWithItsDefault) {
  const YAML::Node root = YAML::LoadFile(kFolder + "full_scale.yaml");
  SimulatorParameters defaults;
  defaults.visitSections([&](const char* name, auto& values) {
    const YAML::Node section = root[name];
    ASSERT_TRUE(section) << name;
    values.visit(DefaultsCheck{section, name});
  });
}

TEST(SimulatorParameters, UnknownKeyIsNamedWithTheNearest) {
  EXPECT_EQ(failureOf("path: {sped: 20}"), "my.yaml: path/sped: no such parameter; did you mean speed?");
}

TEST(SimulatorParameters, UnknownSectionIsNamed) {
  EXPECT_EQ(failureOf("weather: {}"), "my.yaml: weather: no such section");
}

TEST(SimulatorParameters, ValueOutOfRangeIsNamedWithTheRange) {
  EXPECT_EQ(failureOf("image: {supersampling: 0}"),
            "my.yaml: image/supersampling: 0 is out of range, expected 1 to 8");
}

/// Tries values outside each number's range, and expects the message that says so.
struct RangeCheck {
  const std::string section;
  int& checked;

  template <class Number>
  void number(const char* key, Number&, double low, double high, const char* unit, const char*) {
    for (const double bad : {low - 1, high + 1}) {
      std::ostringstream value, range;
      value << bad;
      range << "expected " << low << " to " << high << (*unit != 0 ? " " : "") << unit;
      EXPECT_EQ(failureOf(section + ": {" + key + ": " + value.str() + "}"),
                "my.yaml: " + section + "/" + key + ": " + value.str() + " is out of range, " + range.str());
    }
    EXPECT_EQ(failureOf(section + ": {" + key + ": much}"),
              "my.yaml: " + section + "/" + key + ": 'much' is not a number");
    ++checked;
  }
};

TEST(SimulatorParameters, EachNumberOfTheSceneryIsRefusedOutsideItsRange) {
  SimulatedSceneryParameters defaults;
  int checked = 0;
  defaults.visitSections([&](const char* name, auto& values) { values.visit(RangeCheck{name, checked}); });
  EXPECT_GT(checked, 80);
  EXPECT_EQ(failureOf("runway: {displaced_threshold: -1}"),
            "my.yaml: runway/displaced_threshold: -1 is out of range, expected 0 to 2000 m");
  EXPECT_EQ(failureOf("town: {lenght: 5}"), "my.yaml: town/lenght: no such parameter; did you mean length?");
}

TEST(SimulatorParameters, TextForANumberIsRefused) {
  EXPECT_EQ(failureOf("rig: {x: wide}"), "my.yaml: rig/x: 'wide' is not a number");
}

TEST(SimulatorParameters, MissingFileIsNamed) {
  const Expected<SimulatorParameters> parameters = loadSimulatorParameterFile("/nowhere/a.yaml");
  ASSERT_FALSE(parameters);
  EXPECT_EQ(parameters.error().detail, "/nowhere/a.yaml: no such file");
}

}  // namespace
}  // namespace uav_landing
