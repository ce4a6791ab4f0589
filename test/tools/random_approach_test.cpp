#include "simulation/random_approach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "simulator/ground/ground_profile.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

double spread(const std::vector<double>& values) {
  double square = 0;
  for (const double value : values) square += value * value;
  return std::sqrt(square / static_cast<double>(values.size()));
}

TEST(RandomApproach, SnippetsEndNearTheHeightAskedAtAnyAttitude) {
  double roll = 0, yaw = 0, low_pitch = 0, high_pitch = -1;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    const SimulatorParameters p = drawSnippet(seed, 3, 13, {});
    const Trajectory path(p.path, p.wobble, p.gust, p.random.seed);
    ASSERT_NEAR(p.path.duration, 0.6, 1e-9) << "13 frames at 20 Hz";
    const CameraPose end = path.pose(p.path.duration);
    ASSERT_NEAR(end.position.z(), 3, 0.11);
    ASSERT_LE(std::abs(end.attitude.roll), 8 * kDegree);
    ASSERT_LE(std::abs(end.attitude.yaw), 10 * kDegree);
    ASSERT_LT(std::abs(end.position.y()), 0.5 * p.runway.width);
    roll = std::max(roll, std::abs(end.attitude.roll));
    yaw = std::max(yaw, std::abs(end.attitude.yaw));
    low_pitch = std::min(low_pitch, end.attitude.pitch);
    high_pitch = std::max(high_pitch, end.attitude.pitch);
  }
  EXPECT_GT(roll, 7 * kDegree);
  EXPECT_GT(yaw, 9 * kDegree);
  EXPECT_LT(low_pitch, -7 * kDegree);
  EXPECT_GT(high_pitch, -1 * kDegree);
}

TEST(RandomApproach, CalibrationErrorsAreAsLargeAsTheEstimatorIsTold) {
  Parameters parameters;
  parameters.stereo_depth.disparity_bias_stddev = 0.3;
  std::vector<double> yaw;
  for (uint64_t seed = 0; seed < 1000; ++seed)
    yaw.push_back(drawSnippet(seed, 10, 13, parameters).rig.bend_ry_deg);
  // 0.3 px at 554.26 px; 1000 samples give the deviation to 2.2 %.
  const double asked = 0.3 / 554.26 / kDegree;
  EXPECT_NEAR(spread(yaw), asked, 0.1 * asked);
  // Without a mean and, seed after seed, without correlation: 3 sigma of 1000 samples.
  double sum = 0, products = 0;
  for (size_t i = 0; i + 1 < yaw.size(); ++i) {
    sum += yaw[i] / asked;
    products += yaw[i] * yaw[i + 1] / (asked * asked);
  }
  EXPECT_LT(std::abs(sum) / 1000, 0.1);
  EXPECT_LT(std::abs(products) / 1000, 0.1);
}

TEST(RandomApproach, LensErrorsAreAsLargeAsTheEstimatorExpects) {
  Parameters parameters;
  parameters.stereo_depth.row_bias_stddev = 0.05;
  std::vector<double> rows, tilt;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const SimulatedRigParameters rig = drawSnippet(seed, 10, 13, parameters).rig;
    rows.push_back(rig.lens_rows);
    tilt.push_back(rig.lens_tilt_deg);
  }
  EXPECT_NEAR(spread(rows), 0.05, 0.005) << "px";
  // Rows 0.3 focal lengths from the middle are off by as much.
  EXPECT_NEAR(spread(tilt), 0.05 / (0.3 * 554.26) / kDegree, 0.0017);
  EXPECT_EQ(drawApproach(3).rig.lens_rows, 0) << "an exact calibration";
}

TEST(RandomApproach, GroundBendsByAsMuchAsTheEstimatorIsToldAndTheHeightOverItStays) {
  Parameters parameters;
  parameters.stereo_depth.slope_change_deg = 0.5;
  std::vector<double> changes;
  int bent = 0, beyond = 0;
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    SimulatorParameters p = drawSnippet(seed, 10, 13, parameters);
    bendGround(seed, parameters, p);
    changes.push_back(p.profile.slope_after_deg - p.profile.slope_before_deg);
    const Trajectory path(p.path, p.wobble, p.gust, p.random.seed);
    const Eigen::Vector3d end = path.pose(p.path.duration).position;
    const GroundProfile ground(p.profile);
    ASSERT_NEAR(end.z() - ground.height(end.x()), 10, 0.2);
    if (ground.flat()) continue;
    ++bent;
    beyond += p.profile.change_start > end.x();
    ASSERT_GT(p.profile.change_start + p.profile.change_length, end.x() - 0.5) << "where it could be seen";
  }
  EXPECT_NEAR(bent, 800, 90) << "four kinds with a chance of 0.1 each";
  EXPECT_NEAR(beyond, 2.0 / 3 * bent, 60);
  // A tenth each of 1/16, 1/4, 1 and 2 times 0.5 degrees.
  EXPECT_NEAR(spread(changes), 0.5 * std::sqrt(0.1 * (1 / 256.0 + 1 / 16.0 + 1 + 4)), 0.05);
}

TEST(RandomApproach, ApproachesGoFromSixtyMetresToTheFlareAndStayAboveTheGround) {
  int gusts = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const SimulatorParameters p = drawApproach(seed);
    const Trajectory path(p.path, p.wobble, p.gust, p.random.seed);
    ASSERT_GT(path.pose(0).position.z(), 59);
    double lowest = 1000;
    for (double t = 0; t <= p.path.duration; t += 0.05) lowest = std::min(lowest, path.pose(t).position.z());
    ASSERT_GT(lowest, 0.9) << seed;
    ASSERT_LT(lowest, 5) << seed;
    gusts += p.gust.speed != 0 ? 1 : 0;
  }
  EXPECT_NEAR(gusts, 100, 30);
}

TEST(RandomApproach, FarApproachesComeFromKilometresToTwentyMetresOverRunwaysOfAllSizes) {
  int hills = 0;
  double narrowest = 100, broadest = 0, shortest = 1e4, longest = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const SimulatorParameters p = drawFarApproach(seed);
    const Trajectory path(p.path, p.wobble, p.gust, p.random.seed);
    const CameraPose first = path.pose(0), last = path.pose(p.path.duration);
    ASSERT_LT(first.position.x(), -2999) << seed;
    ASSERT_GT(first.position.x(), -5001) << seed;
    ASSERT_NEAR(last.position.z(), 20, 1) << seed;
    ASSERT_LT(std::abs(last.position.y()), 0.5 * p.runway.width) << "it lands on the runway";
    const GroundProfile ground(p.profile);
    for (double t = 0; t <= p.path.duration; t += 0.5) {
      const Eigen::Vector3d at = path.pose(t).position;
      ASSERT_GT(at.z() - ground.height(at.x()), 3) << seed;
    }
    hills += p.profile.hill_height > 0 ? 1 : 0;
    narrowest = std::min(narrowest, p.runway.width);
    broadest = std::max(broadest, p.runway.width);
    shortest = std::min(shortest, p.runway.length);
    longest = std::max(longest, p.runway.length);
  }
  EXPECT_NEAR(hills, 50, 25);
  EXPECT_NEAR(narrowest, 18, 1);
  EXPECT_NEAR(broadest, 60, 2);
  EXPECT_EQ(shortest, 600);
  EXPECT_EQ(longest, 4000);
}

TEST(RandomApproach, AnInertialSensorIsAsWrongAsTheEstimatorIsToldAndChangesNothingElse) {
  Parameters parameters;
  parameters.approach_angle.imu_attitude_stddev_deg = 0.6;
  parameters.approach_angle.runway_slope_stddev_deg = 0.8;
  std::vector<double> pitch;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const SimulatorParameters with = drawSnippet(seed, 10, 13, parameters, true);
    const SimulatorParameters without = drawSnippet(seed, 10, 13, parameters);
    ASSERT_EQ(with.rig.bend_ry_deg, without.rig.bend_ry_deg);
    ASSERT_EQ(with.path.start_y, without.path.start_y);
    ASSERT_GT(with.imu.rate, 0);
    ASSERT_EQ(without.imu.rate, 0);
    pitch.push_back(with.imu.pitch_error_deg);
  }
  EXPECT_NEAR(spread(pitch), 1.0, 0.1) << "attitude and slope together";
}

TEST(RandomApproach, AGyroscopesBiasAndNoiseAreThoseThatTheEstimatorIsTold) {
  Parameters parameters;
  parameters.approach_angle.imu_rate_bias_deg = 0.2;
  parameters.approach_angle.imu_rate_stddev_deg = 0.05;
  std::vector<double> bias;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    const SimulatedImuParameters imu = drawSnippet(seed, 10, 13, parameters, true).imu;
    for (const double axis : {imu.gyro_bias_x_deg, imu.gyro_bias_y_deg, imu.gyro_bias_z_deg})
      bias.push_back(axis);
    ASSERT_NEAR(imu.gyro_noise_deg, 0.05, 1e-9);
  }
  EXPECT_NEAR(spread(bias), 0.2, 0.015);
}

/// Smallest and largest value of every number of a section.
class Ranges {
 public:
  template <class Number>
  void number(const char* name, Number& value, double, double, const char*, const char*) {
    const auto [range, is_new] = ranges_.insert({name, {value, value}});
    if (is_new) return;
    range->second.first = std::min<double>(range->second.first, value);
    range->second.second = std::max<double>(range->second.second, value);
  }
  void expectAllVary() const {
    EXPECT_GT(ranges_.size(), 5u);
    for (const auto& [name, range] : ranges_)
      EXPECT_GT(range.second - range.first, 0.1 * range.second) << name;
  }

 private:
  std::map<std::string, std::pair<double, double>> ranges_;
};

TEST(RandomApproach, LightGroundAndWobbleAreDifferentEveryTime) {
  Ranges surface, wobble;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    SimulatorParameters p = drawSnippet(seed, 10, 13, {});
    p.surface.visit(surface);
    p.wobble.visit(wobble);
  }
  surface.expectAllVary();
  wobble.expectAllVary();
}

/// Number by number, whether it is within its range; and those of a set of parameters as text.
struct RangeCheck {
  std::string section, text;
  template <class Number>
  void number(const char* name, Number& value, double low, double high, const char*, const char*) {
    EXPECT_GE(value, low) << section << "/" << name;
    EXPECT_LE(value, high) << section << "/" << name;
    text += section + "/" + name + " " + std::to_string(value) + "\n";
  }
  template <class Enum>
  void choice(const char* name, Enum& value, std::initializer_list<const char*>, const char*) {
    text += section + "/" + name + " " + std::to_string(static_cast<int>(value)) + "\n";
  }
};
std::string textOf(SimulatorParameters p) {
  RangeCheck check;
  p.visitSections([&](const char* section, auto& values) {
    check.section = section;
    values.visit(check);
  });
  return check.text;
}

TEST(RandomApproach, SceneryIsDrawnByItsSeedWithinItsRangesAndChangesNothingElse) {
  int fields = 0, towns = 0, rivers = 0, shores = 0, strips = 0, roads = 0, taxiways = 0, crossings = 0,
      noses = 0, posts = 0, displaced = 0;
  constexpr int kSeeds = 400;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SimulatorParameters plain = drawSnippet(seed, 10, 13, {});
    SimulatorParameters with = plain, again = plain, other = plain;
    drawScenery(seed, with);
    drawScenery(seed, again);
    drawScenery(seed + 1, other);
    ASSERT_EQ(textOf(with), textOf(again));
    ASSERT_NE(textOf(with), textOf(other));
    const SimulatedSceneryParameters& p = with.scenery;
    fields += p.fields.width > 0 ? 1 : 0;
    towns += p.town.width > 0 ? 1 : 0;
    if (p.town.width > 0) {
      EXPECT_NEAR(p.town.length, 1200, 800) << seed;
    }
    rivers += p.river.width > 0 ? 1 : 0;
    shores += p.shore.width > 0 ? 1 : 0;
    strips += p.grass_strip.side > 0 ? 1 : 0;
    roads += p.road.width > 0 ? 1 : 0;
    taxiways += p.taxiway.width > 0 ? 1 : 0;
    crossings += p.crossing_runway.width > 0 ? 1 : 0;
    noses += p.own_frame.nose_height > 0 ? 1 : 0;
    posts += p.own_frame.post_width > 0 ? 1 : 0;
    displaced += with.runway.displaced_threshold > 0 ? 1 : 0;
    EXPECT_GE(std::abs(p.taxiway.y), 0.5 * with.runway.width + 40);
    with.scenery = {};
    with.runway.displaced_threshold = 0;
    ASSERT_EQ(textOf(with), textOf(plain));
  }
  // Chances of 0.5, 0.3, 0.25, 0.2 and so on, and 4 sigma of 400 draws: 0.1.
  EXPECT_NEAR(fields, 0.5 * kSeeds, 40);
  EXPECT_NEAR(towns, 0.3 * kSeeds, 40);
  EXPECT_NEAR(rivers, 0.25 * kSeeds, 40);
  EXPECT_NEAR(shores, 0.25 * kSeeds, 40);
  EXPECT_NEAR(strips, 0.85 * kSeeds, 40);
  EXPECT_NEAR(roads, 0.5 * kSeeds, 40);
  EXPECT_NEAR(taxiways, 0.5 * kSeeds, 40);
  EXPECT_NEAR(crossings, 0.25 * kSeeds, 40);
  EXPECT_NEAR(noses, 0.14 * kSeeds, 30);
  EXPECT_NEAR(posts, 0.1 * kSeeds, 30);
  EXPECT_NEAR(displaced, 0.3 * kSeeds, 40);
}

TEST(RandomApproach, RollingShutterAndVibrationAreDrawnWithinTheirRangesAndChangeNothingElse) {
  int from_below = 0, stamp_at_edge = 0;
  constexpr int kSeeds = 400;
  double shortest = 1, longest = 0, weakest = 1, strongest = 0;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const SimulatorParameters plain = drawSnippet(seed, 10, 13, {}, true);
    SimulatorParameters with = plain, again = plain;
    for (SimulatorParameters* p : {&with, &again}) {
      drawRollingShutter(seed, *p);
      drawVibration(seed, *p);
    }
    ASSERT_EQ(textOf(with), textOf(again));
    from_below += with.image.readout_time < 0 ? 1 : 0;
    stamp_at_edge += with.image.stamp_row != 0.5 ? 1 : 0;
    shortest = std::min(shortest, std::abs(with.image.readout_time));
    longest = std::max(longest, std::abs(with.image.readout_time));
    const SimulatedVibrationParameters& v = with.vibration;
    for (const double amplitude : {v.roll_deg, v.pitch_deg, v.yaw_deg}) {
      EXPECT_LE(amplitude, 0.2 * 15 / v.frequency);
      weakest = std::min(weakest, amplitude);
      strongest = std::max(strongest, amplitude);
    }
    EXPECT_GE(with.imu.rate, 8 * v.frequency) << "of an inertial sensor that follows";
    with.image.readout_time = plain.image.readout_time;
    with.image.stamp_row = plain.image.stamp_row;
    with.vibration = plain.vibration;
    with.imu.rate = plain.imu.rate;
    ASSERT_EQ(textOf(with), textOf(plain));
  }
  EXPECT_NEAR(from_below, 0.2 * kSeeds, 40);
  EXPECT_NEAR(stamp_at_edge, 0.5 * kSeeds, 40);
  EXPECT_LT(shortest, 0.0055);
  EXPECT_GT(longest, 0.036);
  EXPECT_LE(longest, 0.05) << "the time from one pair to the next";
  EXPECT_LT(weakest, 0.001);
  EXPECT_GT(strongest, 0.1);
  SimulatorParameters without_imu = drawSnippet(1, 10, 13, {});
  drawVibration(1, without_imu);
  EXPECT_EQ(without_imu.imu.rate, 0);
}

TEST(RandomApproach, ALandscapeHasWhatItsNameSaysAtEveryPlaceOfTheRandomOne) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    for (const auto& [name, kind] : sceneryKinds()) {
      if (kind == SceneryKind::kRandom) continue;
      SCOPED_TRACE(name);
      SimulatorParameters p = drawSnippet(seed, 10, 13, {});
      drawScenery(kind, seed, p);
      EXPECT_EQ(p.scenery.town.width > 0, name == "town");
      EXPECT_EQ(p.scenery.fields.width > 0, name == "fields" || name == "hills");
      EXPECT_EQ(p.scenery.shore.width > 0, name == "shore");
      EXPECT_EQ(p.scenery.river.width > 0, name == "shore");
      EXPECT_EQ(p.scenery.taxiway.width > 0, name == "airport");
      EXPECT_EQ(p.scenery.crossing_runway.width > 0, name == "airport");
      EXPECT_EQ(p.scenery.road.width > 0, name == "town" || name == "fields" || name == "airport");
      EXPECT_EQ(p.profile.hill_height > 0, name == "hills");
      textOf(p);  // within its ranges
    }
  }
}

TEST(RandomApproach, AHillIsBeforeTheThresholdAndNeverInTheWay) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    SimulatorParameters p = drawSnippet(seed, 8, 110, {});
    drawScenery(SceneryKind::kHills, seed, p);
    EXPECT_LE(p.profile.hill_x + 0.5 * p.profile.hill_length, 0);
    const GroundProfile ground(p.profile);
    for (double x = p.path.start_x; x < 0; x += 5) {
      const double height =
          p.path.start_height - (x - p.path.start_x) * std::tan(p.path.glide_angle_deg * M_PI / 180);
      ASSERT_GT(height, ground.height(x)) << seed << " at " << x;
    }
  }
}

TEST(RandomApproach, SeedDecidesEverything) {
  const SimulatorParameters one = drawSnippet(7, 10, 13, {}), again = drawSnippet(7, 10, 13, {});
  EXPECT_EQ(one.runway.width, again.runway.width);
  EXPECT_EQ(one.path.roll_deg, again.path.roll_deg);
  EXPECT_NE(one.path.roll_deg, drawSnippet(8, 10, 13, {}).path.roll_deg);
}

}  // namespace
}  // namespace uav_landing
