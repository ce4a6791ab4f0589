#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "datasets/decimal_time.h"
#include "offline/estimate_csv.h"
#include "offline/pair_count.h"
#include "offline/timing_table.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char letter : line) {
    if (letter == ',')
      fields.emplace_back();
    else
      fields.back() += letter;
  }
  return fields;
}

/// The rows that EstimateCsv makes of this pair, by the names in its header.
std::map<std::string, std::string> rowOf(const ProcessedPair& pair) {
  const std::string path = testing::TempDir() + "uav_landing_offline_sinks_test.csv";
  EstimateCsv csv(path);
  csv.take(pair);
  csv.finish();
  std::ifstream file(path);
  std::string header, row, more;
  EXPECT_TRUE(std::getline(file, header) && std::getline(file, row));
  EXPECT_FALSE(std::getline(file, more)) << more;
  std::remove(path.c_str());
  const std::vector<std::string> names = split(header), fields = split(row);
  std::map<std::string, std::string> named;
  EXPECT_EQ(names.size(), fields.size());
  for (size_t i = 0; i < std::min(names.size(), fields.size()); ++i) named[names[i]] = fields[i];
  EXPECT_EQ(named.size(), names.size()) << "a name is there twice";
  return named;
}

TEST(EstimateCsv, EachColumnHasItsOwnNumberInTheUnitOfItsName) {
  Pipeline::Output output;
  output.approach.readout = {0.025, 0.004 * 0.004};
  LandingResult& landing = output.landing;
  landing.status = Status::kCoasting;
  landing.failure = {Reason::kRejected, "raw height 3 m"};
  landing.height_valid = true;
  landing.height = 12.5;
  landing.height_variance = 0.01;
  landing.raw_height = 12.75;
  landing.raw_height_variance = 7;
  landing.vertical_speed = -1.25;
  landing.vertical_speed_variance = 8;
  landing.approach_angle = 3 * kDegree;
  landing.approach_angle_variance = std::pow(0.25 * kDegree, 2);
  landing.raw_approach_angle = 3.5 * kDegree;
  landing.raw_approach_angle_variance = 9;
  landing.pitch = -4 * kDegree;
  landing.roll = 5 * kDegree;
  landing.yaw = -6 * kDegree;
  landing.yaw_variance = std::pow(0.6 * kDegree, 2);
  landing.yaw_failure = {Reason::kNoRunway, "another one"};
  landing.other_runway_probability = 0.0625;
  landing.x = -100;
  landing.x_variance = 4;
  landing.y = 1.5;
  landing.y_variance = 0.25;
  landing.foe = {310, 250};
  landing.velocity = {3, 4, 12};
  landing.twist_covariance.setZero();
  landing.twist_covariance.topLeftCorner<3, 3>() = 0.09 * Eigen::Matrix3d::Identity();
  landing.height_protection_level = 0.4;
  landing.height_alert_limit = 0.6;
  landing.protection_source = "near_region";
  landing.runway_width = 45;
  landing.width_height = 12.25;
  landing.width_height_variance = 0.16;
  landing.y_protection_level = 2.125;
  landing.height_above_runway = 13.5;
  landing.height_above_runway_variance = 0.36;
  landing.height_above_runway_known = true;
  landing.height_above_runway_protection_level = 1.75;
  landing.height_above_runway_limit = 2.25;
  landing.height_origin = HeightOrigin::kGeometry;
  landing.runway_failure = {Reason::kInconsistent, "another width"};
  landing.rig_rotation.w = Eigen::Vector3d(0.01, 0.02, 0.03) * kDegree;
  landing.rig_rotation.covariance =
      Eigen::Vector3d(0.0001, 0.0004, 0.0009).asDiagonal() * Eigen::Matrix3d::Identity() * kDegree * kDegree;
  TestResult passed, failed;
  passed.name = "tilt";
  passed.ratio = 1;
  failed.name = "innovation";
  failed.ratio = 10;
  passed.limit = failed.limit = 9;
  landing.tests = {passed, failed};
  output.stages.add("stereo_depth", 3);
  output.stages.add("kalman_height", 4);

  const StereoRig rig;
  std::map<std::string, std::string> row =
      rowOf({ros::Time(1700000000, 123456789), "left", 0, {}, rig, output});
  const std::map<std::string, double> numbers{{"height_m", 12.5},
                                              {"height_stddev_m", 0.1},
                                              {"raw_height_m", 12.75},
                                              {"vertical_speed_m_s", -1.25},
                                              {"approach_angle_deg", 3},
                                              {"approach_angle_stddev_deg", 0.25},
                                              {"raw_approach_angle_deg", 3.5},
                                              {"pitch_deg", -4},
                                              {"roll_deg", 5},
                                              {"yaw_deg", -6},
                                              {"x_m", -100},
                                              {"x_stddev_m", 2},
                                              {"y_m", 1.5},
                                              {"y_stddev_m", 0.5},
                                              {"y_protection_level_m", 2.125},
                                              {"foe_u_px", 310},
                                              {"foe_v_px", 250},
                                              {"compute_ms", 7},
                                              {"height_protection_level_m", 0.4},
                                              {"height_alert_limit_m", 0.6},
                                              {"runway_width_m", 45},
                                              {"width_height_m", 12.25},
                                              {"width_height_stddev_m", 0.4},
                                              {"height_above_runway_m", 13.5},
                                              {"height_above_runway_stddev_m", 0.6},
                                              {"height_above_runway_protection_level_m", 1.75},
                                              {"height_above_runway_limit_m", 2.25},
                                              {"rig_rx_deg", 0.01},
                                              {"rig_ry_deg", 0.02},
                                              {"rig_rz_deg", 0.03},
                                              {"rig_rx_stddev_deg", 0.01},
                                              {"rig_ry_stddev_deg", 0.02},
                                              {"rig_rz_stddev_deg", 0.03},
                                              {"speed_m_s", 13},
                                              {"speed_stddev_m_s", 0.3},
                                              {"yaw_stddev_deg", 0.6},
                                              {"other_runway_probability", 0.0625},
                                              {"estimated_readout_time_s", 0.025},
                                              {"estimated_readout_time_stddev_s", 0.004}};
  for (const auto& [name, value] : numbers) {
    ASSERT_EQ(row.count(name), 1u) << name;
    ASSERT_FALSE(row[name].empty()) << name;
    EXPECT_NEAR(std::stod(row[name]), value, 1e-9) << name;
    row.erase(name);
  }
  const std::map<std::string, std::string> texts{{"stamp_s", "1700000000.123456789"},
                                                 {"valid", "0"},
                                                 {"height_valid", "1"},
                                                 {"angle_valid", "0"},
                                                 {"status", "coasting"},
                                                 {"reason", "rejected"},
                                                 {"yaw_known", "1"},
                                                 {"yaw_reason", "no_runway"},
                                                 {"height_above_runway_known", "1"},
                                                 {"height_origin", "geometry"},
                                                 {"runway_reason", "inconsistent"},
                                                 {"protection_source", "near_region"},
                                                 {"failed_tests", "innovation"}};
  EXPECT_EQ(row, texts) << "all other columns";
}

TEST(EstimateCsv, WhatIsNotKnownIsBlankAndEachFlagIsItsOwn) {
  const StereoRig rig;
  for (const bool height : {false, true}) {
    for (const bool angle : {false, true}) {
      Pipeline::Output output;
      output.landing.height_valid = height;
      output.landing.angle_valid = angle;
      std::map<std::string, std::string> row = rowOf({ros::Time(1), "left", 0, {}, rig, output});
      EXPECT_EQ(row["height_valid"], height ? "1" : "0");
      EXPECT_EQ(row["angle_valid"], angle ? "1" : "0");
      EXPECT_EQ(row["valid"], height && angle ? "1" : "0");
      for (const char* unknown :
           {"height_m", "height_stddev_m", "yaw_deg", "x_m", "x_stddev_m", "rig_rx_deg"})
        EXPECT_EQ(row[unknown], "") << unknown;
    }
  }
}

/// Numbers of the table's line that begins with this name.
std::vector<double> numbersOf(const std::string& table, const std::string& name) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(name + " ", 0) != 0) continue;
    std::istringstream fields(line.substr(name.size()));
    std::vector<double> numbers;
    for (double number; fields >> number;) numbers.push_back(number);
    return numbers;
  }
  return {};
}

TEST(TimingTable, HasEachPartAndAllOfThemOfThePairsThatWereProcessed) {
  std::ostringstream out;
  TimingTable table(out);
  const StereoRig rig;
  for (const double ms : {2.0, 4.0}) {
    Pipeline::Output output;
    output.parts.add("edges", ms);
    output.parts.add("corners", 10 * ms);
    output.stages.add("stereo_depth", 11 * ms + 1);
    table.take({ros::Time(1), "left", 0, {}, rig, output});
  }
  // A pair that could not be used took no time, and is none of those that the means are of.
  table.take({ros::Time(2), "left", 0, {Reason::kInputInvalid, "no image"}, rig, Pipeline::Output()});
  table.finish();
  const std::vector<double> edges = numbersOf(out.str(), "edges"), corners = numbersOf(out.str(), "corners"),
                            all = numbersOf(out.str(), "all stages");
  // Mean, median (the smaller one of two), 99 %, worst, total in s.
  ASSERT_EQ(edges.size(), 5u) << out.str();
  EXPECT_NEAR(edges[0], 3, 0.005);
  EXPECT_NEAR(edges[1], 2, 0.02) << "to 1 %";
  EXPECT_NEAR(edges[2], 4, 0.04);
  EXPECT_NEAR(edges[3], 4, 0.005);
  EXPECT_NEAR(edges[4], 0.006, 0.005);
  ASSERT_EQ(corners.size(), 5u);
  EXPECT_NEAR(corners[0], 30, 0.005);
  EXPECT_NEAR(corners[4], 0.06, 0.005);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_NEAR(all[0], 34, 0.005);
  EXPECT_NEAR(all[3], 45, 0.005);
  EXPECT_LT(out.str().find("corners"), out.str().find("edges")) << "what takes longest comes first";
}

TEST(PairCount, CountsEachReasonTheMostFrequentFirst) {
  std::ostringstream out;
  PairCount count(out);
  const StereoRig rig;
  const auto take = [&](bool valid, Reason reason) {
    Pipeline::Output output;
    output.landing.status = Status::kTracking;
    output.landing.height_valid = output.landing.angle_valid = valid;
    output.landing.failure = {reason, ""};
    count.take({ros::Time(1), "left", 0, {}, rig, output});
  };
  take(true, Reason::kNone);
  take(false, Reason::kNotYet);
  for (int i = 0; i < 2; ++i) take(false, Reason::kUniformImage);
  take(false, Reason::kNone);
  count.finish();
  EXPECT_EQ(out.str(), "5 pairs, 1 valid: uniform_image 2, no reason given 1, not_yet 1\n");
}

/// Lines that a recording of these pairs ends with; failed: a test that fails on the pair, or "". repeated:
/// cameras whose pictures are those of the pair before.
std::string toldOf(const std::vector<std::pair<Reason, std::string>>& pairs, int repeated = 0) {
  std::ostringstream out;
  PairCount count(out);
  const StereoRig rig;
  for (const auto& [reason, failed] : pairs) {
    Pipeline::Output output;
    output.landing.status = Status::kTracking;
    output.landing.height_valid = output.landing.angle_valid = reason == Reason::kNone;
    output.landing.failure = {reason, reason == Reason::kUniformImage ? "right image has no contrast" : ""};
    output.stereo.left_repeated = repeated > 1;
    output.stereo.right_repeated = repeated > 0;
    TestResult test;
    test.name = failed;
    test.ratio = failed.empty() ? 0 : 10;
    test.limit = 9;
    output.landing.tests = {test};
    count.take({ros::Time(1), "left", 0, {}, rig, output});
  }
  count.finish();
  return out.str();
}

std::vector<std::pair<Reason, std::string>> times(int count, Reason reason, const std::string& failed = "") {
  return std::vector<std::pair<Reason, std::string>>(count, {reason, failed});
}

TEST(PairCount, TellsTheTestsThatFailedAndTheLikelyCause) {
  std::vector<std::pair<Reason, std::string>> pairs = times(15, Reason::kRejected, "tilt");
  const auto more = times(6, Reason::kInconsistent, "baseline_direction");
  pairs.insert(pairs.end(), more.begin(), more.end());
  const std::string told = toldOf(pairs);
  EXPECT_EQ(
      told.rfind(
          "pairs on which a test failed: tilt 15, baseline_direction 6\nlikely cause: the images of a pair "
          "were not taken at the same time (test baseline_direction)",
          0),
      0u)
      << told;
  EXPECT_NE(told.find("\n21 pairs, 0 valid: rejected 15, inconsistent 6\n"), std::string::npos) << told;
}

TEST(PairCount, TellsEachCauseByWhatShowsIt) {
  const auto hasCause = [](const std::vector<std::pair<Reason, std::string>>& pairs,
                           const std::string& cause) {
    const std::string told = toldOf(pairs);
    EXPECT_NE(told.find("likely cause: " + cause), std::string::npos) << told;
  };
  hasCause(times(10, Reason::kNegativeDisparity), "left and right images are swapped");
  hasCause(times(10, Reason::kInconsistent, "repeated_image"), "images of one camera come twice");
  hasCause(times(10, Reason::kUniformImage),
           "images are black, saturated or uniform (right image has no contrast): exposure");
  hasCause(times(10, Reason::kUniformImage, "repeated_image"), "images are black, saturated or uniform");
  hasCause(times(10, Reason::kInconsistent, "row_agreement"),
           "the rows of left and right images do not belong together");
  hasCause(times(10, Reason::kUncertain, "row_motion"), "rows of the images move on their own");
  hasCause(times(10, Reason::kInconsistent, "sink_rate"), "heights change otherwise than the motion says");
  hasCause(times(10, Reason::kNoPlane), "the images show hardly any texture");
  hasCause(times(10, Reason::kNoMotion), "the cameras stand still");
  hasCause(times(10, Reason::kTransformMissing),
           "most pairs are transform_missing: see docs/troubleshooting.md");
  std::vector<std::pair<Reason, std::string>> blinking;
  for (int i = 0; i < 10; ++i)
    blinking.push_back({i % 2 == 0 ? Reason::kUniformImage : Reason::kTooFewMatches, ""});
  hasCause(blinking, "every second image is black or uniform");
}

TEST(PairCount, TellsCamerasThatStandStillFromOneThatHangs) {
  const auto pairs = times(10, Reason::kInconsistent, "repeated_image");
  EXPECT_NE(toldOf(pairs, 1).find("likely cause: images of one camera come twice"), std::string::npos);
  const std::string told = toldOf(pairs, 2);
  EXPECT_NE(told.find("likely cause: the images of both cameras come again, bit by bit: the cameras stand "
                      "still and have no noise (a simulator), or the driver sends no new images"),
            std::string::npos)
      << told;
}

TEST(PairCount, TellsNoCauseWhereMostIsValidOrLittleIsKnown) {
  std::vector<std::pair<Reason, std::string>> pairs = times(10, Reason::kNone);
  const auto more = times(10, Reason::kInconsistent, "row_agreement");
  pairs.insert(pairs.end(), more.begin(), more.end());
  EXPECT_EQ(toldOf(pairs).find("likely cause"), std::string::npos);
  EXPECT_EQ(toldOf(times(9, Reason::kNoPlane)).find("likely cause"), std::string::npos);
}

}  // namespace
}  // namespace uav_landing
