#include "height/camera_velocity.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace uav_landing;

namespace {

/// 2 m forward and 0.2 m down in 0.1 s from a height of 10 m, known to 1 mm across and 2 mm forward.
ApproachAngleResult::Motion someStep() {
  ApproachAngleResult::Motion step;
  step.duration = 0.1;
  step.rotation.setZero();
  step.translation_over_height = Eigen::Vector3d(0, 0.02, 0.2);
  step.covariance.setZero();
  step.covariance.diagonal().tail<3>() = Eigen::Array3d(1e-4, 1e-4, 2e-4).square();
  return step;
}

TEST(CameraVelocity, IsTheStepInMetresASecond) {
  const CameraVelocity velocity = cameraVelocity(someStep(), 10, 0, 0);
  EXPECT_NEAR((velocity.mean - Eigen::Vector3d(0, 2, 20)).norm(), 0, 1e-12);
  // A millimetre in a tenth of a second is 1 cm/s.
  EXPECT_NEAR(std::sqrt(velocity.covariance(0, 0)), 0.01, 1e-12);
  EXPECT_NEAR(std::sqrt(velocity.covariance(2, 2)), 0.02, 1e-12);
  EXPECT_NEAR(velocity.covariance(1, 2), 0, 1e-15);
}

TEST(CameraVelocity, ErrsWithHeightAndStampsAlongItself) {
  // 3 % of the height and 4 % of the duration are 5 % of the length.
  const CameraVelocity velocity = cameraVelocity(someStep(), 10, 0.3 * 0.3, 0.04 * 0.04);
  const double step = 0.01, length = 0.05 * 20;
  EXPECT_NEAR(velocity.covariance(0, 0), step * step, 1e-12) << "nothing across the way";
  EXPECT_NEAR(velocity.covariance(2, 2), 4 * step * step + length * length, 1e-12);
  EXPECT_NEAR(velocity.covariance(1, 2), length * length / 10, 1e-12) << "a tenth of it down";
}

TEST(CameraVelocity, IsUnknownWithoutAStepOrAHeight) {
  ApproachAngleResult::Motion step = someStep();
  EXPECT_TRUE(cameraVelocity(step, kUnknown, kUnknown, 0).covariance.array().isNaN().all());
  step.failure = {Reason::kNoMotion, ""};
  EXPECT_TRUE(cameraVelocity(step, 10, 0.01, 0).mean.array().isNaN().all());
  step = someStep();
  step.duration = 0;
  EXPECT_TRUE(cameraVelocity(step, 10, 0.01, 0).mean.array().isNaN().all());
}

}  // namespace
