#include "height/camera_twist.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace uav_landing;

namespace {

/// 2 m forward and 0.2 m down in 0.1 s from a height of 10 m, known to 1 mm across and 2 mm forward, while
/// the ground turns by 0.01 about y (to the right), known to 0.001.
ApproachAngleResult::Motion someStep() {
  ApproachAngleResult::Motion step;
  step.duration = 0.1;
  step.rotation = Eigen::Vector3d(0, 0.01, 0);
  step.translation_over_height = Eigen::Vector3d(0, 0.02, 0.2);
  step.covariance.setZero();
  step.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-8, 1e-8, 4e-8;
  step.covariance(1, 3) = step.covariance(3, 1) = 5e-8;  // turning to the right looks like moving there
  return step;
}

TEST(CameraTwist, IsTheStepInMetresAndRadiansASecond) {
  const CameraTwist twist = cameraTwist(someStep(), 10, 0, 0);
  EXPECT_NEAR((twist.velocity - Eigen::Vector3d(0, 2, 20)).norm(), 0, 1e-12);
  EXPECT_NEAR((twist.angular_velocity - Eigen::Vector3d(0, -0.1, 0)).norm(), 0, 1e-12) << "to the left";
  // A millimetre in a tenth of a second is 1 cm/s.
  EXPECT_NEAR(std::sqrt(twist.covariance(0, 0)), 0.01, 1e-12);
  EXPECT_NEAR(std::sqrt(twist.covariance(2, 2)), 0.02, 1e-12);
  EXPECT_NEAR(std::sqrt(twist.covariance(4, 4)), 0.01, 1e-12);
  EXPECT_NEAR(twist.covariance(1, 2), 0, 1e-15);
}

TEST(CameraTwist, TurnAndMovementErrTogether) {
  const CameraTwist twist = cameraTwist(someStep(), 10, 0, 0);
  // Half of both stddevs, and the camera turns against the picture.
  EXPECT_NEAR(twist.covariance(0, 4), -0.5 * 0.01 * 0.01, 1e-12);
  EXPECT_EQ(twist.covariance(4, 0), twist.covariance(0, 4));
}

TEST(CameraTwist, ErrsWithTheHeightAlongTheWay) {
  const double step = 0.01, length = 0.03 * 20;
  const CameraTwist twist = cameraTwist(someStep(), 10, 0.3 * 0.3, 0);
  EXPECT_NEAR(twist.covariance(0, 0), step * step, 1e-12) << "nothing across the way";
  EXPECT_NEAR(twist.covariance(2, 2), 4 * step * step + length * length, 1e-12);
  EXPECT_NEAR(twist.covariance(1, 2), length * length / 10, 1e-12) << "a tenth of it down";
  EXPECT_NEAR(twist.covariance(4, 4), step * step, 1e-12);
  EXPECT_NEAR(twist.covariance(2, 4), 0, 1e-15) << "a turn is the same from any height";
}

TEST(CameraTwist, ErrsWithTheStampsInAllOfIt) {
  const double step = 0.01, length = 0.04 * 20, turn = 0.04 * 0.1;
  const CameraTwist twist = cameraTwist(someStep(), 10, 0, 0.04 * 0.04);
  EXPECT_NEAR(twist.covariance(2, 2), 4 * step * step + length * length, 1e-12);
  EXPECT_NEAR(twist.covariance(4, 4), step * step + turn * turn, 1e-12);
  EXPECT_NEAR(twist.covariance(2, 4), -length * turn, 1e-12);
}

TEST(CameraTwist, IsUnknownWithoutAStepOrAHeight) {
  ApproachAngleResult::Motion step = someStep();
  EXPECT_TRUE(cameraTwist(step, kUnknown, kUnknown, 0).velocity.array().isNaN().all());
  step.failure = {Reason::kNoMotion, ""};
  EXPECT_TRUE(cameraTwist(step, 10, 0.01, 0).covariance.array().isNaN().all());
  step = someStep();
  step.duration = 0;
  EXPECT_TRUE(cameraTwist(step, 10, 0.01, 0).velocity.array().isNaN().all());
}

}  // namespace
