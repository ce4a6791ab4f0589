#include "rig/plane_by_turns.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

const Eigen::Vector3d kPlane = Eigen::Vector3d(0.05, 0.99, 0.1).normalized() / 5;

/// The plane that is fitted to disparities of the ground, in rows of 20 ms. turnAt: of the camera, at a time
/// since the stamp.
template <class TurnAt>
StereoDepthResult turnedPair(const StereoRig& rig, const RowTimes& times, const TurnAt& turnAt) {
  StereoDepthResult pair;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int v = 260; v < 480; v += 15)
    for (int u = 20; u < 640; u += 60) {
      const Eigen::Vector3d row = rig.fb() * rig.ray(u, v);
      // The plane in the frame of the row, turned exactly.
      const Eigen::Vector3d turn = turnAt(times.at(u, v));
      const Eigen::Vector3d seen = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * kPlane;
      information += row * row.transpose();
      right += row * row.dot(turn.isZero(0) ? kPlane : seen);
      StereoDepthResult::Point point;
      point.u = u;
      point.v = v;
      point.on_plane = true;
      pair.points.push_back(point);
    }
  pair.plane.g = information.ldlt().solve(right);
  pair.plane.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  return pair;
}

TEST(PlaneByTurns, ThatWereMeasuredIsTakenOff) {
  const StereoRig rig = test::makeRig(640, 480, 1);
  const RowTimes times(test::calibrationOf(rig), {0.02, 0.5});
  std::vector<Eigen::Vector3d> rates;
  for (int i = -12; i <= 12; ++i) rates.push_back({0.5 * std::cos(280 * i * RowTurns::kInterval), 0, 0});
  const GyroTurn turns{
      std::make_shared<const RowTurns>(-12 * RowTurns::kInterval, rates, Eigen::Matrix3d::Zero())};
  StereoDepthResult pair = turnedPair(rig, times, [&](double seconds) { return turns.at(seconds); });
  const Eigen::Vector3d error = pair.plane.g - kPlane;
  const ApproachAngleResult::PlaneByTurns by_turns = planeByTurns(rig, times, {turns, {}}, pair);
  EXPECT_GT(error.norm(), 1e-4 * kPlane.norm()) << "the vibration must matter";
  EXPECT_LT((by_turns.mean - error).norm(), 0.02 * error.norm());
  takeOff(by_turns, pair);
  EXPECT_LT((pair.plane.g - kPlane).norm(), 0.02 * error.norm());
  EXPECT_NEAR(std::sqrt(pair.plane.covariance.trace()), 0.3 * error.norm(), 0.02 * error.norm());
  const auto tellsNothing = [](const ApproachAngleResult::PlaneByTurns& by) {
    return by.mean.isZero(0) && by.covariance.isZero(0);
  };
  const Vibration vibration{1e-3, 1};
  EXPECT_FALSE(tellsNothing(planeByTurns(rig, times, {turns, vibration}, pair)));
  EXPECT_TRUE(tellsNothing(planeByTurns(rig, times, {}, pair)));
  EXPECT_TRUE(tellsNothing(planeByTurns(rig, {}, {turns, vibration}, pair))) << "all rows at once";
  pair.points.resize(5);
  EXPECT_TRUE(tellsNothing(planeByTurns(rig, times, {turns, vibration}, pair))) << "too few points";
}

/// A vibration of any phase about one axis. Its size is known, and its frequency to a third.
TEST(PlaneByTurns, OfVibrationThatNothingMeasuredIsClaimed) {
  constexpr double kReadout = 0.02, kStddev = 5e-4;  // s, rad
  constexpr int kDrawn = 300;
  const StereoRig rig = test::makeRig(640, 480, 1);
  const RowTimes times(test::calibrationOf(rig), {kReadout, 0.5});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> phase(0, 2 * M_PI);
  std::normal_distribution<double> times_faster(1, 1 / M_PI);
  for (const double cycles : {0.7, 1.7}) {
    // In one axis: a sine's variance is half of its amplitude's square, and the mean is of three axes.
    const double amplitude = std::sqrt(6.0) * kStddev;
    double heights = 0, rolls = 0;
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitZ().eval()}) {
      for (int i = 0; i < kDrawn; ++i) {
        const double begin = phase(random), speed = 2 * M_PI * times_faster(random) * cycles / kReadout;
        const auto turnAt = [&](double seconds) -> Eigen::Vector3d {
          return amplitude * std::sin(speed * seconds + begin) * axis;
        };
        StereoDepthResult pair = turnedPair(rig, times, turnAt);
        const Eigen::Vector3d turn = turnAt(0);
        const Eigen::Vector3d at_stamp = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * kPlane;
        const Eigen::Vector3d error = pair.plane.g - at_stamp;
        takeOff(planeByTurns(rig, times, {{}, {kStddev, cycles}}, pair), pair);
        const Eigen::Vector3d up = kPlane.normalized();
        double& squares = axis.x() > 0 ? heights : rolls;
        const Eigen::Vector3d along = axis.x() > 0 ? up : Eigen::Vector3d::UnitX().eval();
        squares += std::pow(error.dot(along), 2) / along.dot(pair.plane.covariance * along) / kDrawn;
        EXPECT_LE((pair.plane.covariance - pair.row_covariance).norm(), 1e-11);
      }
    }
    EXPECT_NEAR(std::sqrt(heights), 1, 0.15) << cycles;
    EXPECT_NEAR(std::sqrt(rolls), 1, 0.15) << cycles;
  }
}

TEST(PlaneByTurns, ThatIsTooLargeForVibrationIsNotTakenOff) {
  StereoDepthResult pair;
  pair.plane = {kPlane, 1e-12 * Eigen::Matrix3d::Identity()};
  const Eigen::Matrix3d before = pair.plane.covariance;
  const Eigen::Vector3d off = 0.2 * kPlane;
  takeOff({off, Eigen::Matrix3d::Zero()}, pair);
  EXPECT_EQ(pair.plane.g, kPlane);
  EXPECT_LT((pair.plane.covariance - before - off * off.transpose()).norm(), 1e-12);
}

}  // namespace
}  // namespace uav_landing
