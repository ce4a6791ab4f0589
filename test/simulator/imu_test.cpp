#include "uav_landing/simulator/imu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

Trajectory rolling() {
  SimulatedPathParameters path;
  path.pitch_deg = -4;
  SimulatedWobbleParameters wobble;
  wobble.roll_deg = 8;
  return {path, wobble, {}, 1};
}

SimulatedImuParameters exact() {
  SimulatedImuParameters imu;
  imu.rate = 50;
  imu.attitude_noise_deg = imu.gyro_noise_deg = 0;
  return imu;
}

/// What the chain makes of it.
AttitudePrior priorAt(const SimulatedImu& imu, double t, double before, double delay = 0) {
  ApproachAngleParameters parameters;
  parameters.imu_delay = delay;
  ImuBuffer buffer(parameters);
  for (int i = 0; i < imu.count(5); ++i) buffer.add(imu.sample(i));
  return buffer.at(t, before, opticalFromImu());
}

TEST(SimulatedImu, SaysWhatTheTrajectorySays) {
  const Trajectory path = rolling();
  const double t = 2.013, before = 1.95;
  const AttitudePrior prior = priorAt({exact(), path, 1}, t, before);
  EXPECT_NEAR(pitchOf(prior.normal), path.pose(t).attitude.pitch, 0.01 * kDegree);
  EXPECT_NEAR(rollOf(prior.normal), path.pose(t).attitude.roll, 0.01 * kDegree);
  const Eigen::AngleAxisd turn(runwayFromOptical(path.pose(t).attitude).transpose() *
                               runwayFromOptical(path.pose(before).attitude));
  EXPECT_GT(turn.angle(), 0.1 * kDegree) << "a movement worth the name";
  EXPECT_LT((prior.rotation - turn.angle() * turn.axis()).norm(), 0.005 * kDegree);
}

TEST(SimulatedImu, HasTheErrorsAskedFor) {
  const Trajectory path = rolling();
  SimulatedImuParameters imu = exact();
  imu.pitch_error_deg = 0.7;
  imu.roll_error_deg = -0.4;
  imu.gyro_bias_y_deg = 3;
  imu.delay = 0.1;
  const AttitudePrior wrong = priorAt({imu, path, 1}, 2.0, 1.9, 0.1);
  const AttitudePrior right = priorAt({exact(), path, 1}, 2.0, 1.9);
  EXPECT_NEAR(pitchOf(wrong.normal) - pitchOf(right.normal), 0.7 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(rollOf(wrong.normal) - rollOf(right.normal), -0.4 * kDegree, 0.06 * kDegree);
  // Turning its nose down at 3 deg/s carries the ground up: about the camera's x axis.
  EXPECT_NEAR((wrong.rotation - right.rotation).x(), 0.3 * kDegree, 0.03 * kDegree);
}

TEST(SimulatedImu, NoiseIsOfTheSizeAskedForAndTheSameForTheSameSeed) {
  const Trajectory path = rolling();
  SimulatedImuParameters imu = exact();
  imu.attitude_noise_deg = 0.2;
  imu.gyro_noise_deg = 0.5;
  const SimulatedImu noisy(imu, path, 3), again(imu, path, 3), clean(exact(), path, 3);
  const int count = noisy.count(20);
  ASSERT_EQ(count, 1001);
  double attitude = 0, rate = 0;
  for (int i = 0; i < count; ++i) {
    const Eigen::AngleAxisd off(clean.sample(i).orientation->conjugate() * *noisy.sample(i).orientation);
    attitude += off.angle() * off.angle() / (3 * count);
    rate +=
        (*noisy.sample(i).angular_velocity - *clean.sample(i).angular_velocity).squaredNorm() / (3 * count);
    EXPECT_EQ(noisy.sample(i).angular_velocity, again.sample(i).angular_velocity);
  }
  // 3000 numbers tell a standard deviation to 1.3 %.
  EXPECT_NEAR(std::sqrt(attitude), 0.2 * kDegree, 0.05 * 0.2 * kDegree);
  EXPECT_NEAR(std::sqrt(rate), 0.5 * kDegree, 0.05 * 0.5 * kDegree);
}

TEST(SimulatedImu, SeesVibrationAtItsOwnRate) {
  SimulatedWobbleParameters still;
  still.roll_deg = still.pitch_deg = still.yaw_deg = 0;
  SimulatedVibrationParameters vibration;
  vibration.frequency = 45;
  vibration.pitch_deg = 0.2;
  const Trajectory path({}, still, {}, 1, vibration);
  SimulatedImuParameters fast = exact();
  fast.rate = 400;
  const SimulatedImu imu(fast, path, 1);
  // The angular velocity of a sine of 0.2 degrees at 45 Hz; pitching up is negative about the left axis.
  const double expected = 2 * M_PI * 45 * 0.2 * kDegree;
  double largest = 0;
  for (int i = 0; i < imu.count(1); ++i) {
    const Eigen::Vector3d rate = *imu.sample(i).angular_velocity;
    largest = std::max(largest, std::abs(rate.y()));
    EXPECT_LT(std::hypot(rate.x(), rate.z()), 0.02 * expected);
  }
  EXPECT_NEAR(largest, expected, 0.01 * expected);
  // Its messages give the turn between two moments that lie less than a period apart.
  double turned = 0;
  constexpr int kFrom = 160, kTo = 164;
  for (int i = kFrom; i < kTo; ++i)
    turned -= 0.5 * (imu.sample(i).angular_velocity->y() + imu.sample(i + 1).angular_velocity->y()) / 400;
  const double true_turn = path.pose(kTo / 400.0).attitude.pitch - path.pose(kFrom / 400.0).attitude.pitch;
  EXPECT_GT(std::abs(true_turn), 0.05 * kDegree);
  EXPECT_NEAR(turned, true_turn, 0.06 * std::abs(true_turn));
}

}  // namespace
}  // namespace uav_landing
