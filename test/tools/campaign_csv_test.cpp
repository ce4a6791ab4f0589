#include "simulation/campaign_csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(CampaignCsv, EachColumnHasItsOwnNumberInTheUnitOfItsName) {
  Truth truth;
  truth.height = 10;
  truth.approach_angle = 3 * kDegree;
  truth.pitch = -4 * kDegree;
  truth.roll = 5 * kDegree;
  truth.yaw = -6 * kDegree;
  truth.x = -100;
  truth.y = 1.5;
  truth.speed = 20;
  Pipeline::Output output;
  output.stages.add("stereo_depth", 7);
  LandingResult& landing = output.landing;
  landing.height_valid = true;
  landing.failure = {Reason::kNotYet, "2 of 3"};
  landing.height = 10.25;
  landing.height_variance = 0.01;
  landing.raw_height = 10.5;
  landing.raw_height_variance = 0.04;
  landing.approach_angle = 3.25 * kDegree;
  landing.approach_angle_variance = std::pow(0.3 * kDegree, 2);
  landing.raw_approach_angle = 3.5 * kDegree;
  landing.raw_approach_angle_variance = std::pow(0.4 * kDegree, 2);
  landing.pitch = -4.25 * kDegree;
  landing.pitch_variance = std::pow(0.5 * kDegree, 2);
  landing.roll = 5.25 * kDegree;
  landing.roll_variance = std::pow(0.6 * kDegree, 2);
  landing.yaw = -6.25 * kDegree;
  landing.yaw_variance = std::pow(0.7 * kDegree, 2);
  landing.x = -101;
  landing.x_variance = 0.64;
  landing.y = 1.75;
  landing.y_variance = 0.81;
  landing.velocity = {3, 4, 12};
  landing.twist_covariance.setZero();
  landing.twist_covariance.topLeftCorner<3, 3>() = 1.21 * Eigen::Matrix3d::Identity();
  landing.height_above_runway = 12.5;
  landing.height_above_runway_variance = 0.25;
  landing.height_above_runway_known = true;
  landing.height_above_runway_protection_level = 1.5;
  SimulatorParameters drawn;
  drawn.rig.stretch = 0.001;
  drawn.rig.bend_rx_deg = 0.01;
  drawn.rig.bend_ry_deg = 0.02;
  drawn.rig.bend_rz_deg = 0.03;
  drawn.rig.lens_rows = 0.05;
  drawn.rig.lens_tilt_deg = 0.06;
  drawn.profile.slope_before_deg = 0.25;
  drawn.profile.slope_after_deg = 1;
  drawn.runway.width = 33;
  drawn.runway.length = 1200;
  drawn.image.readout_time = -0.02;
  drawn.vibration.frequency = 45;
  drawn.vibration.roll_deg = 0.1;
  drawn.vibration.pitch_deg = 0.2;
  drawn.vibration.yaw_deg = 0.2;
  CampaignCsv::Sample sample;
  sample.seed = 17;
  sample.cell_height = 11;
  sample.noise = 2;
  sample.chart = true;
  sample.height_above_runway = 12;
  sample.frame = 4;
  sample.time = 0.2;

  const std::string path = testing::TempDir() + "uav_landing_campaign_csv_test.csv";
  {
    CampaignCsv csv(path);
    csv.write(sample, drawn, truth, output);
    csv.finish();
  }
  std::ifstream file(path);
  std::string header, row, more;
  ASSERT_TRUE(std::getline(file, header) && std::getline(file, row));
  EXPECT_FALSE(std::getline(file, more));
  std::remove(path.c_str());
  std::map<std::string, std::string> named;
  std::istringstream names(header), fields(row);
  for (std::string name, field; std::getline(names, name, ',');) {
    ASSERT_TRUE(std::getline(fields, field, ',')) << name;
    EXPECT_TRUE(named.insert({name, field}).second) << name;
  }
  EXPECT_FALSE(std::getline(fields, more, ',')) << "a field without a name";
  EXPECT_EQ(named["reason"], "not_yet");
  named.erase("reason");

  const std::map<std::string, double> expected{{"seed", 17},
                                               {"cell_height_m", 11},
                                               {"noise", 2},
                                               {"frame", 4},
                                               {"time_s", 0.2},
                                               {"valid", 0},
                                               {"height_valid", 1},
                                               {"angle_valid", 0},
                                               {"compute_ms", 7},
                                               {"height_true_m", 10},
                                               {"height_m", 10.25},
                                               {"height_stddev_m", 0.1},
                                               {"raw_height_m", 10.5},
                                               {"raw_height_stddev_m", 0.2},
                                               {"approach_angle_true_deg", 3},
                                               {"approach_angle_deg", 3.25},
                                               {"approach_angle_stddev_deg", 0.3},
                                               {"raw_approach_angle_deg", 3.5},
                                               {"raw_approach_angle_stddev_deg", 0.4},
                                               {"pitch_true_deg", -4},
                                               {"pitch_deg", -4.25},
                                               {"pitch_stddev_deg", 0.5},
                                               {"roll_true_deg", 5},
                                               {"roll_deg", 5.25},
                                               {"roll_stddev_deg", 0.6},
                                               {"yaw_true_deg", -6},
                                               {"yaw_deg", -6.25},
                                               {"yaw_stddev_deg", 0.7},
                                               {"x_true_m", -100},
                                               {"x_m", -101},
                                               {"x_stddev_m", 0.8},
                                               {"y_true_m", 1.5},
                                               {"y_m", 1.75},
                                               {"y_stddev_m", 0.9},
                                               {"stretch", 0.001},
                                               {"bend_rx_deg", 0.01},
                                               {"bend_ry_deg", 0.02},
                                               {"bend_rz_deg", 0.03},
                                               {"lens_rows_px", 0.05},
                                               {"lens_tilt_deg", 0.06},
                                               {"slope_change_deg", 0.75},
                                               {"speed_true_m_s", 20},
                                               {"speed_m_s", 13},
                                               {"speed_stddev_m_s", 1.1},
                                               {"runway_width_m", 33},
                                               {"chart", 1},
                                               {"runway_length_m", 1200},
                                               {"height_above_runway_true_m", 12},
                                               {"height_above_runway_m", 12.5},
                                               {"height_above_runway_stddev_m", 0.5},
                                               {"height_above_runway_known", 1},
                                               {"height_above_runway_protection_level_m", 1.5},
                                               {"readout_time_s", -0.02},
                                               {"vibration_hz", 45},
                                               {"vibration_deg", 0.3}};
  EXPECT_EQ(named.size(), expected.size());
  for (const auto& [name, value] : expected) {
    ASSERT_EQ(named.count(name), 1u) << name;
    ASSERT_FALSE(named[name].empty()) << name;
    EXPECT_NEAR(std::stod(named[name]), value, 1e-9) << name;
  }
}

}  // namespace
}  // namespace uav_landing
