#include "uav_landing/simulator/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/lens.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

SimulatedWobbleParameters still() {
  SimulatedWobbleParameters wobble;
  wobble.roll_deg = wobble.pitch_deg = wobble.yaw_deg = wobble.sway = wobble.heave = 0;
  return wobble;
}

/// Angle of the path below the horizontal at a time, from two positions 2 ms apart.
double pathAngle(const Trajectory& trajectory, double t) {
  const Eigen::Vector3d step = trajectory.pose(t + 1e-3).position - trajectory.pose(t - 1e-3).position;
  return std::atan2(-step.z(), std::hypot(step.x(), step.y()));
}

TEST(Attitude, NegativePitchLooksDown) {
  EXPECT_NEAR(runwayFromOptical({0, -0.2, 0}).col(2).z(), std::sin(-0.2), 1e-12);
}

TEST(Attitude, PositiveRollPutsTheRightSideDown) {
  EXPECT_NEAR(runwayFromOptical({0.3, 0, 0}).col(0).z(), -std::sin(0.3), 1e-12);
}

TEST(Attitude, PositiveYawTurnsLeft) {
  EXPECT_NEAR(runwayFromOptical({0, 0, 0.1}).col(2).y(), std::sin(0.1), 1e-12);
}

TEST(Attitude, AllThreeTogetherMeanWhatTheAnglesMean) {
  const Eigen::Matrix3d rotation = runwayFromOptical({0.2, -0.1, 0.3});
  EXPECT_TRUE(rotation.isApprox(axesOf(0.2, -0.1, 0.3), 1e-12)) << rotation;
}

TEST(Attitude, IsWhatTheChainReadsFromTheGroundNormal) {
  const Eigen::Matrix3d rotation = runwayFromOptical({0.2, -0.1, 0.3});
  const Eigen::Vector3d normal = rotation.transpose() * -Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(rollOf(normal), 0.2, 1e-12);
  EXPECT_NEAR(pitchOf(normal), -0.1, 1e-12);
  EXPECT_NEAR(yawOf(normal, rotation.transpose() * Eigen::Vector3d::UnitX()), 0.3, 1e-12);
}

TEST(Trajectory, GlidesStraightAtTheAngleAndSpeedAsked) {
  SimulatedPathParameters path;
  path.start_height = 40, path.start_x = -300, path.start_y = 2, path.flare_height = 0;
  path.speed = 20, path.glide_angle_deg = 3, path.track_deg = 2;
  const Eigen::Vector3d position = Trajectory(path, still(), {}, 1).pose(5).position;
  const double level = 100 * std::cos(3 * kDegree);
  EXPECT_NEAR(position.x(), -300 + level * std::cos(2 * kDegree), 1e-9);
  EXPECT_NEAR(position.y(), 2 + level * std::sin(2 * kDegree), 1e-9);
  EXPECT_NEAR(position.z(), 40 - 100 * std::sin(3 * kDegree), 1e-9);
}

TEST(Trajectory, FlareChangesTheAngleSteadilyFromItsHeightOn) {
  SimulatedPathParameters path;
  path.start_height = 15, path.speed = 20, path.glide_angle_deg = 5;
  path.flare_height = 6, path.flare_duration = 4, path.flare_angle_deg = 1, path.flare_pitch_deg = 3;
  path.pitch_deg = -5;
  const Trajectory trajectory(path, still(), {}, 1);
  const double begin = 9 / (20 * std::sin(5 * kDegree));
  EXPECT_NEAR(trajectory.pose(begin).position.z(), 6, 1e-9);
  EXPECT_NEAR(pathAngle(trajectory, begin - 0.5), 5 * kDegree, 1e-6);
  EXPECT_NEAR(pathAngle(trajectory, begin + 1), 4 * kDegree, 1e-6);
  EXPECT_NEAR(pathAngle(trajectory, begin + 3), 2 * kDegree, 1e-6);
  EXPECT_NEAR(pathAngle(trajectory, begin + 4.5), 1 * kDegree, 1e-6);
  EXPECT_NEAR(trajectory.pose(begin + 2).attitude.pitch, -3.5 * kDegree, 1e-9);
  const Eigen::Vector3d step =
      trajectory.pose(begin + 2.001).position - trajectory.pose(begin + 1.999).position;
  EXPECT_NEAR(step.norm(), 20 * 0.002, 1e-7) << "the speed stays";
}

TEST(Trajectory, GustAddsItsSpeedAtThePeakAndLeavesTheAircraftLower) {
  SimulatedPathParameters path;
  path.start_height = 40, path.speed = 20, path.glide_angle_deg = 3, path.flare_height = 0;
  SimulatedGustParameters gust;
  gust.speed = 2, gust.start = 1, gust.duration = 3;
  const Trajectory with(path, still(), gust, 1), without(path, still(), {}, 1);
  const auto sinkSpeed = [](const Trajectory& trajectory, double t) {
    return (trajectory.pose(t - 1e-4).position.z() - trajectory.pose(t + 1e-4).position.z()) / 2e-4;
  };
  const double glide = 20 * std::sin(3 * kDegree);
  EXPECT_NEAR(sinkSpeed(with, 0.9), glide, 1e-6);
  EXPECT_NEAR(sinkSpeed(with, 1.75), glide + 1, 1e-6) << "half way up";
  EXPECT_NEAR(sinkSpeed(with, 2.5), glide + 2, 1e-6) << "peak";
  EXPECT_NEAR(sinkSpeed(with, 4.1), glide, 1e-6);
  // The mean of (1 - cos) / 2 is a half: 2 m/s / 2 x 3 s.
  EXPECT_NEAR(without.pose(5).position.z() - with.pose(5).position.z(), 3, 1e-9);
}

TEST(Trajectory, WobbleStaysWithinItsAmplitudeAndComesCloseToIt) {
  SimulatedWobbleParameters wobble = still();
  wobble.roll_deg = 3, wobble.roll_period = 4;
  const Trajectory trajectory({}, wobble, {}, 1);
  double largest = 0;
  for (double t = 0; t < 200; t += 0.05)
    largest = std::max(largest, std::abs(trajectory.pose(t).attitude.roll) / kDegree);
  EXPECT_LE(largest, 3.0);
  EXPECT_GT(largest, 2.5);
}

TEST(Trajectory, SeedChoosesThePhases) {
  const Trajectory one({}, {}, {}, 1), again({}, {}, {}, 1), other({}, {}, {}, 2);
  EXPECT_EQ(one.pose(3).attitude.roll, again.pose(3).attitude.roll);
  EXPECT_NE(one.pose(3).attitude.roll, other.pose(3).attitude.roll);
}

class TruthTest : public testing::Test {
 protected:
  const CameraPose before_{{-50, 1.0, 10}, {0.01, -0.02, 0.03}};
  const CameraPose now_{{-49, 1.1, 9.9}, {0.05, -0.08, 0.02}};
  const Eigen::Matrix3d K_ = (Eigen::Matrix3d() << 500, 0, 320, 0, 500, 240, 0, 0, 1).finished();
};

TEST_F(TruthTest, FirstFrameHasNoStep) {
  const Truth truth = truthOf(now_, nullptr, 0.05, K_);
  EXPECT_EQ(truth.height, 9.9);
  EXPECT_TRUE(std::isnan(truth.approach_angle));
  EXPECT_TRUE(std::isnan(truth.foe.x()));
  EXPECT_TRUE(std::isnan(truth.speed));
}

TEST_F(TruthTest, ApproachAngleAndSpeedAreTheChords) {
  const Truth truth = truthOf(now_, &before_, 0.05, K_);
  EXPECT_NEAR(truth.approach_angle, std::atan2(0.1, std::hypot(1.0, 0.1)), 1e-12);
  EXPECT_NEAR(truth.speed, std::sqrt(1.0 + 0.01 + 0.01) / 0.05, 1e-9);
}

TEST_F(TruthTest, FocusOfExpansionIsWhereTheChordLeadsInTheCurrentImage) {
  const Truth truth = truthOf(now_, &before_, 0.05, K_);
  const Eigen::Vector3d ahead = now_.position + 1e6 * (now_.position - before_.position);
  const Eigen::Vector3d seen = axesOf(0.05, -0.08, 0.02).transpose() * (ahead - now_.position);
  EXPECT_NEAR(truth.foe.x(), 320 + 500 * seen.x() / seen.z(), 1e-6);
  EXPECT_NEAR(truth.foe.y(), 240 + 500 * seen.y() / seen.z(), 1e-6);
}

TEST_F(TruthTest, FocusOfExpansionMayLieAboveTheImage) {
  const CameraPose looking_down{now_.position, {0, -0.8, 0}};
  const Truth truth = truthOf(looking_down, &before_, 0.05, K_);
  EXPECT_LT(truth.foe.y(), 0);
  const double above = 0.8 - std::atan2(0.1, std::hypot(1.0, 0.1));  // of the optical axis
  EXPECT_NEAR(truth.foe.y(), 240 - 500 * std::tan(above), 5);
}

TEST_F(TruthTest, AttitudeAndPositionAreTheCurrentFrames) {
  const Truth truth = truthOf(now_, &before_, 0.05, K_);
  EXPECT_EQ(truth.roll, 0.05);
  EXPECT_EQ(truth.pitch, -0.08);
  EXPECT_EQ(truth.yaw, 0.02);
  EXPECT_EQ(truth.x, -49);
  EXPECT_EQ(truth.y, 1.1);
}

TEST_F(TruthTest, StandingStillHasASpeedButNoDirection) {
  const Truth truth = truthOf(now_, &now_, 0.05, K_);
  EXPECT_EQ(truth.speed, 0);
  EXPECT_TRUE(std::isnan(truth.approach_angle));
  EXPECT_TRUE(std::isnan(truth.foe.x()));
}

TEST_F(TruthTest, FlyingBackwardsHasNoFocusOfExpansion) {
  const Truth truth = truthOf(before_, &now_, 0.05, K_);
  EXPECT_TRUE(std::isnan(truth.foe.x()));
  EXPECT_NEAR(truth.approach_angle, -std::atan2(0.1, std::hypot(1.0, 0.1)), 1e-12);
}

/// Attitude at 2000 moments of a second.
template <class Value>
std::vector<double> overOneSecond(const Trajectory& trajectory, double from, Value&& value) {
  std::vector<double> values;
  for (int i = 0; i < 2000; ++i) values.push_back(value(trajectory.pose(from + i / 2000.0).attitude));
  return values;
}

TEST(Trajectory, VibratesByTheAmplitudesAndTheFrequencyAsked) {
  SimulatedVibrationParameters vibration;
  vibration.frequency = 43;
  vibration.roll_deg = 0.1, vibration.pitch_deg = 0.4, vibration.yaw_deg = 0.2;
  SimulatedPathParameters path;
  path.flare_height = 0, path.roll_deg = 3, path.pitch_deg = -5, path.yaw_deg = 2;
  const Trajectory trajectory(path, still(), {}, 1, vibration);
  const auto check = [&](double middle, double amplitude, auto&& value) {
    const std::vector<double> values = overOneSecond(trajectory, 1, value);
    EXPECT_NEAR(*std::max_element(values.begin(), values.end()), (middle + amplitude) * kDegree,
                1e-3 * kDegree);
    EXPECT_NEAR(*std::min_element(values.begin(), values.end()), (middle - amplitude) * kDegree,
                1e-3 * kDegree);
    int rises = 0;
    for (size_t i = 1; i < values.size(); ++i)
      if (values[i - 1] <= middle * kDegree && values[i] > middle * kDegree) ++rises;
    EXPECT_NEAR(rises, 43, 1);
  };
  check(3, 0.1, [](const Attitude& a) { return a.roll; });
  check(-5, 0.4, [](const Attitude& a) { return a.pitch; });
  check(2, 0.2, [](const Attitude& a) { return a.yaw; });
  const Eigen::Vector3d at = Trajectory(path, still(), {}, 1).pose(1.01).position;
  EXPECT_EQ(trajectory.pose(1.01).position, at) << "it turns about the camera";
}

TEST(Trajectory, VibrationMayBeginInFlightAndGrowsOverAPeriod) {
  SimulatedVibrationParameters vibration;
  vibration.frequency = 20;
  vibration.pitch_deg = 1;
  vibration.start = 2;
  const Trajectory quiet({}, {}, {}, 1), shaken({}, {}, {}, 1, vibration);
  const auto added = [&](double t) { return shaken.pose(t).attitude.pitch - quiet.pose(t).attitude.pitch; };
  double largest = 0, later = 0;
  for (double t = 0; t < 2; t += 1e-3) EXPECT_EQ(added(t), 0);
  for (double t = 2; t < 2.01; t += 1e-3) largest = std::max(largest, std::abs(added(t)));
  for (double t = 2.05; t < 2.1; t += 1e-3) later = std::max(later, std::abs(added(t)));
  EXPECT_LT(largest, 0.21 * kDegree) << "a fifth of a period";
  EXPECT_NEAR(later, kDegree, 0.01 * kDegree);
}

TEST(Trajectory, VibrationLeavesTheOtherDisturbancesAsTheyAre) {
  SimulatedVibrationParameters vibration;
  vibration.pitch_deg = 1;
  const CameraPose with = Trajectory({}, {}, {}, 5, vibration).pose(3),
                   without = Trajectory({}, {}, {}, 5).pose(3);
  EXPECT_EQ(with.attitude.roll, without.attitude.roll);
  EXPECT_EQ(with.position, without.position);
}

}  // namespace
}  // namespace uav_landing
