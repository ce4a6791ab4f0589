#include "uav_landing/parameters/parameter_file.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "parameters/moved_parameters.h"
#include "support/bad_configurations.h"
#include "support/documentation.h"

namespace uav_landing {
namespace {

std::string errorOf(const std::string& yaml) {
  const Expected<Parameters> parameters = parseParameters(yaml, "test.yaml");
  return parameters ? "accepted" : parameters.error().detail;
}

/// Writes every number of a section as YAML.
struct Writer {
  std::ostringstream& out;
  template <class Number>
  void number(const char* name, Number& value, double, double, const char*, const char*) {
    const bool given = !(value != value);  // NaN: it has none
    if (given) out << "  " << name << ": " << value << "\n";
  }
  void flag(const char*, bool&, const char*) {}
  void text(const char*, std::string&, const char*) {}
  template <class Enum>
  void choice(const char*, Enum&, std::initializer_list<const char*>, const char*) {}
};

/// Finds a parameter by its name.
struct NameFinder {
  const std::string name;
  bool found = false;
  template <class... Rest>
  void number(const char* candidate, Rest&&...) {
    found = found || name == candidate;
  }
  template <class... Rest>
  void flag(const char* candidate, Rest&&...) {
    found = found || name == candidate;
  }
  template <class... Rest>
  void text(const char* candidate, Rest&&...) {
    found = found || name == candidate;
  }
  template <class Enum>
  void choice(const char* candidate, Enum&, std::initializer_list<const char*>, const char*) {
    found = found || name == candidate;
  }
};

/// path: section/name.
bool isParameter(const std::string& path) {
  const size_t slash = path.find('/');
  NameFinder finder{path.substr(slash + 1)};
  Parameters().visitSections([&](const std::string& section, auto& values) {
    if (section == path.substr(0, slash)) values.visit(finder);
  });
  return finder.found;
}

TEST(ParameterFile, TakesGivenValuesAndKeepsTheOtherDefaults) {
  const Expected<Parameters> parameters = parseParameters(
      "stereo_depth: {window_radius: 7, matching_cost: ssd, warp_window: false}\n"
      "kalman_height:\n  gate: 4.5\n  height_source: points\n",
      "test.yaml");
  ASSERT_TRUE(parameters) << parameters.error().message();
  EXPECT_EQ(parameters->stereo_depth.window_radius, 7);
  EXPECT_EQ(parameters->stereo_depth.matching_cost, MatchingCost::kSsd);
  EXPECT_FALSE(parameters->stereo_depth.warp_window);
  EXPECT_EQ(parameters->stereo_depth.corner_count, StereoDepthParameters().corner_count);
  EXPECT_DOUBLE_EQ(parameters->kalman_height.gate, 4.5);
  EXPECT_EQ(parameters->kalman_height.height_source, HeightSource::kPoints);
}

TEST(ParameterFile, EmptyFileAndEmptySectionMeanDefaults) {
  EXPECT_EQ(errorOf(""), "accepted");
  EXPECT_EQ(errorOf("stereo_depth:\n"), "accepted");
}

TEST(ParameterFile, NamesTheNearestParameterForAnUnknownOne) {
  EXPECT_EQ(errorOf("stereo_depth: {window_raduis: 5}"),
            "test.yaml: stereo_depth/window_raduis: no such parameter; did you mean window_radius?");
  EXPECT_EQ(errorOf("stereo_depth: {qqq: 5}"), "test.yaml: stereo_depth/qqq: no such parameter");
}

TEST(ParameterFile, NamesTheNearestSectionForAnUnknownOne) {
  EXPECT_EQ(errorOf("stereo_dept: {window_radius: 5}"),
            "test.yaml: stereo_dept: no such section; did you mean stereo_depth?");
}

TEST(ParameterFile, TakesWhatStagesShareFromSectionsOfTheirOwn) {
  const Expected<Parameters> parameters =
      parseParameters("rig: {max_baseline: 60}\nrunway: {width: 45}\n", "test.yaml");
  ASSERT_TRUE(parameters) << parameters.error().message();
  EXPECT_EQ(parameters->rig.max_baseline, 60);
  EXPECT_EQ(parameters->runway.width, 45);
  EXPECT_EQ(Parameters().runway.width, 0) << "unknown";
}

TEST(ParameterFile, RefusesARunwayThatContradictsItself) {
  EXPECT_EQ(errorOf("runway: {width: 45, length: 20}\n"),
            "test.yaml: runway/length: 20 m, expected at least runway/width, 45 m");
  EXPECT_EQ(errorOf("runway: {width: 18, side_stripe_inset: 9}\n"),
            "test.yaml: runway/side_stripe_inset: 9 m, expected less than half of runway/width, 18 m");
  EXPECT_TRUE(parseParameters("runway: {width: 45, length: 45, side_stripe_inset: 2}\n", "test.yaml"));
  EXPECT_TRUE(parseParameters("runway: {length: 20, side_stripe_inset: 9, paved: false}\n", "test.yaml"))
      << "nothing is known of the width";
}

TEST(ParameterFile, RefusesAWidthThatNoRunwayHas) {
  EXPECT_EQ(errorOf("runway: {width: -1}\n"),
            "test.yaml: runway/width: -1 is out of range, expected 0 to 200 m");
  EXPECT_EQ(errorOf("runway: {width: 4500}\n"),
            "test.yaml: runway/width: 4500 is out of range, expected 0 to 200 m");
}

TEST(ParameterFile, SaysWhereAKeyBelongs) {
  EXPECT_EQ(errorOf("approach_angle: {runway_width: 30}\n"),
            "test.yaml: approach_angle/runway_width: has moved to runway/width");
  EXPECT_EQ(errorOf("kalman_height: {known_runway_width: 30}\n"),
            "test.yaml: kalman_height/known_runway_width: has moved to runway/width");
  EXPECT_EQ(errorOf("kalman_height: {runway: {width: 30}}\n"),
            "test.yaml: kalman_height/runway: is a section of its own, expected beside kalman_height");
  EXPECT_EQ(errorOf("runway: {rig: {max_baseline: 60}}\n"),
            "test.yaml: runway/rig: is a section of its own, expected beside runway");
  EXPECT_EQ(errorOf("approach_angle: {known_runway_width: 30}\n"),
            "test.yaml: approach_angle/known_runway_width: no such parameter")
      << "it never was there";
}

TEST(ParameterFile, WhatHasMovedIsNowhereElse) {
  for (const MovedParameter& moved : kMovedParameters) {
    EXPECT_FALSE(isParameter(moved.was)) << moved.was;
    EXPECT_TRUE(isParameter(moved.now)) << moved.now;
  }
}

TEST(ParameterFile, RefusesWhatTheDocumentationSaysInItsWords) {
  for (const char* heading : {"Parameters", "Files"})
    for (const test::BadConfiguration& row : test::badConfigurations(heading))
      EXPECT_EQ(errorOf(row.given), "test.yaml: " + row.message);
}

TEST(ParameterFile, RefusesValuesOutOfRangeWithTheRange) {
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 99}"),
            "test.yaml: stereo_depth/window_radius: 99 is out of range, expected 2 to 15 px");
  EXPECT_EQ(errorOf("stereo_depth: {min_zncc: 1.5}"),
            "test.yaml: stereo_depth/min_zncc: 1.5 is out of range, expected 0 to 1");
  EXPECT_EQ(errorOf("kalman_height: {gate: .nan}"),
            "test.yaml: kalman_height/gate: nan is out of range, expected 1 to 20 sigma");
  EXPECT_EQ(errorOf("kalman_height: {gate: .inf}"),
            "test.yaml: kalman_height/gate: inf is out of range, expected 1 to 20 sigma");
}

TEST(ParameterFile, NamesTheFirstOfSeveralMistakes) {
  const std::string first = "test.yaml: stereo_depth/window_radius: 99 is out of range, expected 2 to 15 px";
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 99, min_zncc: 1.5, warp_window: 2}"), first);
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 99, window_raduis: 5}"), first);
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 99}\nkalman_height: {gate: 99}\n"), first);
}

TEST(ParameterFile, AcceptsBothEndsOfTheRange) {
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 2}"), "accepted");
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 15}"), "accepted");
  EXPECT_NE(errorOf("stereo_depth: {window_radius: 1}"), "accepted");
  EXPECT_NE(errorOf("stereo_depth: {window_radius: 16}"), "accepted");
}

TEST(ParameterFile, RefusesValuesOfAnotherType) {
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: 5.5}"),
            "test.yaml: stereo_depth/window_radius: '5.5' is not a whole number");
  EXPECT_EQ(errorOf("stereo_depth: {window_radius: large}"),
            "test.yaml: stereo_depth/window_radius: 'large' is not a whole number");
  EXPECT_EQ(errorOf("kalman_height: {gate: [1, 2]}"),
            "test.yaml: kalman_height/gate: a list or map is not a number");
  EXPECT_EQ(errorOf("kalman_height: {gate: }"), "test.yaml: kalman_height/gate: nothing is not a number");
  EXPECT_EQ(errorOf("stereo_depth: {warp_window: 2}"),
            "test.yaml: stereo_depth/warp_window: '2' is not true or false");
  EXPECT_EQ(errorOf("stereo_depth: {matching_cost: sad}"),
            "test.yaml: stereo_depth/matching_cost: 'sad' is not a choice, expected zncc or ssd");
}

TEST(ParameterFile, RefusesAKeyThatIsGivenTwice) {
  EXPECT_EQ(errorOf("kalman_height:\n  gate: 4\n  gate: 5\n"),
            "test.yaml: kalman_height/gate: is given twice");
  EXPECT_EQ(errorOf("overlay: {}\noverlay: {}\n"), "test.yaml: overlay: is given twice");
}

TEST(ParameterFile, RefusesWhatIsNotAMap) {
  EXPECT_EQ(errorOf("- 1\n- 2\n"), "test.yaml: expected a map of names and values");
  EXPECT_EQ(errorOf("overlay: 5\n"), "test.yaml: overlay: expected a map of names and values");
}

TEST(ParameterFile, NamesTheLineOfASyntaxError) {
  const std::string error = errorOf("overlay: {scale: 1\nrectify: {}\n");
  EXPECT_NE(error.find("test.yaml: "), std::string::npos);
  EXPECT_NE(error.find("line "), std::string::npos) << error;
}

TEST(ParameterFile, SaysWhichFileCannotBeRead) {
  const Expected<Parameters> missing = loadParameterFile("/nowhere/config.yaml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().detail, "/nowhere/config.yaml: no such file");
  const Expected<Parameters> folder = loadParameterFile(UAV_LANDING_SOURCE_DIR);
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().detail, UAV_LANDING_SOURCE_DIR ": cannot be read");
}

TEST(ParameterFile, FilesThatItNamesAreRelativeToItsFolder) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "parameter_file_test";
  std::filesystem::create_directories(folder / "config");
  const std::string file = (folder / "config" / "rig.yaml").string();
  std::ofstream(file) << "rig: {left_mask: ../masks/nose.png, right_mask: /elsewhere/nose.png}";
  const Expected<Parameters> parameters = loadParameterFile(file);
  ASSERT_TRUE(parameters) << parameters.error().message();
  EXPECT_EQ(parameters->rig.left_mask, (folder / "masks" / "nose.png").string());
  EXPECT_EQ(parameters->rig.right_mask, "/elsewhere/nose.png");
  std::ofstream(file) << "rig: {max_baseline: 20}";
  EXPECT_EQ(loadParameterFile(file)->rig.left_mask, "") << "none, and not the folder";
  std::filesystem::remove_all(folder);
}

TEST(ParameterFile, DefaultsLieWithinTheirOwnRanges) {
  // Every number that has a default must load again when it is written out.
  std::ostringstream yaml;
  Parameters().visitSections([&](const char* section, auto& values) {
    yaml << section << ":\n";
    values.visit(Writer{yaml});
  });
  EXPECT_EQ(errorOf(yaml.str()), "accepted") << yaml.str();
}

TEST(ParameterFile, ShippedPresetsLoad) {
  for (const char* name : {"stereo", "fast", "paper"}) {
    const auto parameters =
        loadParameterFile(std::string(UAV_LANDING_SOURCE_DIR "/config/") + name + ".yaml");
    EXPECT_TRUE(parameters) << parameters.error().message();
  }
}

/// The row of a parameter in a table of parameters.
std::string rowOf(const std::string& table, const std::string& section, const std::string& name) {
  const size_t begin = table.find("\n| `" + name + "` |", table.find("\n## " + section + "\n"));
  return begin == std::string::npos ? "" : table.substr(begin + 1, table.find('\n', begin + 1) - begin - 1);
}

TEST(ParameterTable, HasTheWordsThatPeopleSearchFor) {
  const std::string table = parameterTable();
  for (const auto& [word, section, name] : std::initializer_list<std::array<const char*, 3>>{
           {"frozen", "kalman_height", "max_deceleration"},
           {"repeats", "kalman_height", "max_deceleration"},
           {"outlier", "kalman_height", "gate"},
           {"outlier", "kalman_height", "vanishing_point_gate"},
           {"outlier", "stereo_depth", "plane_tolerance"},
           {"outlier", "approach_angle", "ransac_tolerance"},
           {"innovation gate", "kalman_height", "gate"},
           {"timeout", "kalman_height", "max_age"},
           {"timeout", "kalman_height", "reset_timeout"},
           {"RANSAC", "stereo_depth", "plane_tolerance"},
           {"process noise", "kalman_height", "acceleration_stddev"},
           {"exposure", "stereo_depth", "matching_cost"},
           {"synchronisation", "rectify", "approximate_sync"},
           {"latency", "approach_angle", "imu_delay"},
           {"false alarm", "kalman_height", "false_alarm_rate"},
           {"bent rig", "kalman_height", "rig_watch"},
           {"cropped", "rig", "max_principal_point_offset"},
           {"nose", "rig", "left_mask"},
           {"propeller", "rig", "left_mask"},
           {"computing time", "stereo_depth", "corner_count"}})
    EXPECT_NE(rowOf(table, section, name).find(word), std::string::npos) << word << " in " << name;
}

TEST(ParameterTable, IsTheOneInTheDocumentation) {
  test::expectPage("parameters.md", parameterTable(), "--list-parameters");
}

}  // namespace
}  // namespace uav_landing
