#include "body_twist.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

using namespace uav_landing;

namespace {

constexpr double kT = 0.05, kHeight = 8;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A step with errors that go together, and what a height that is exact makes of it.
struct Case {
  Matrix6d step_covariance;  // of (rotation of the ground, movement over the height)
  LandingResult camera;

  Case(const Eigen::Vector3d& rotation, const Eigen::Vector3d& t) {
    Matrix6d root = 1e-4 * Matrix6d::Identity();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j) root(i, j) = 1e-5 * (3 * i - 2 * j);
    step_covariance = root * root.transpose();
    camera.velocity = kHeight / kT * t;
    camera.angular_velocity = -rotation / kT;
    Matrix6d by_step = Matrix6d::Zero();
    by_step.topRightCorner<3, 3>().diagonal().setConstant(kHeight / kT);
    by_step.bottomLeftCorner<3, 3>().diagonal().setConstant(-1 / kT);
    camera.twist_covariance = by_step * step_covariance * by_step.transpose();
  }
  std::optional<BodyTwist> twist(const Eigen::Isometry3d& child, double acceleration = 0) const {
    return bodyTwist(camera, kT, acceleration, child);
  }
};

/// By where points that are fixed to the frame come in a short part of the step, seen from the camera before.
Vector6d byPoses(const Eigen::Vector3d& rotation, const Eigen::Vector3d& t, const Eigen::Isometry3d& child) {
  constexpr double kShort = 1e-3;  // of the step, so that the way is straight
  const Eigen::Vector3d w = kShort * rotation;
  const Eigen::Matrix3d then_from_now =
      (w.norm() > 0 ? Eigen::AngleAxisd(-w.norm(), w.normalized()).toRotationMatrix()
                    : Eigen::Matrix3d::Identity());
  const auto moved = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return then_from_now * (point + kShort * kHeight * t);
  };
  const auto velocity = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return child.linear().transpose() * (moved(point) - point) / (kShort * kT);
  };
  Vector6d twist;
  twist.head<3>() = velocity(child.translation());
  const Eigen::Vector3d x = velocity(child * Eigen::Vector3d::UnitX()) - twist.head<3>();
  const Eigen::Vector3d y = velocity(child * Eigen::Vector3d::UnitY()) - twist.head<3>();
  twist.tail<3>() << y.z(), -x.z(), x.y();
  return twist;
}

Eigen::Isometry3d someChild() {
  Eigen::Isometry3d child = Eigen::Isometry3d::Identity();
  child.linear() = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
                    Eigen::AngleAxisd(-1.2, Eigen::Vector3d(1, 2, -1).normalized()))
                       .toRotationMatrix();
  child.translation() << 0.4, -0.3, -1.5;
  return child;
}

TEST(BodyTwist, OfTheCameraIsItsVelocityAndTheTurnOfTheGroundReversed) {
  const Case c({0, 0.01, 0}, {0, 0, 0.1});
  const auto twist = c.twist(Eigen::Isometry3d::Identity());
  ASSERT_TRUE(twist);
  EXPECT_NEAR((twist->linear - Eigen::Vector3d(0, 0, 16)).norm(), 0, 1e-12);
  // About y, down, the ground turns to the right: the camera to the left.
  EXPECT_NEAR((twist->angular - Eigen::Vector3d(0, -0.2, 0)).norm(), 0, 1e-12);
}

TEST(BodyTwist, OfAnAircraftBehindTheCameraSwingsOutOfATurn) {
  // forward-left-up, 2 m behind the camera.
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  base.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  base.translation() << 0, 0, -2;
  const Case c({0, 0.01, 0}, {0, 0, 0.1});
  const auto twist = c.twist(base);
  ASSERT_TRUE(twist);
  EXPECT_NEAR((twist->angular - Eigen::Vector3d(0, 0, 0.2)).norm(), 0, 1e-12) << "to the left";
  EXPECT_NEAR((twist->linear - Eigen::Vector3d(16, -0.4, 0)).norm(), 0, 1e-12) << "the tail to the right";
}

TEST(BodyTwist, IsHowPointsOfTheFrameMove) {
  const Eigen::Vector3d rotation(0.02, -0.03, 0.01), t(0.01, 0.02, 0.15);
  const Case c(rotation, t);
  const auto twist = c.twist(someChild());
  ASSERT_TRUE(twist);
  const Vector6d expected = byPoses(rotation, t, someChild());
  EXPECT_NEAR((twist->linear - expected.head<3>()).norm(), 0, 1e-2);
  EXPECT_NEAR((twist->angular - expected.tail<3>()).norm(), 0, 1e-3);
}

TEST(BodyTwist, ErrsAsTheStepDoes) {
  const Eigen::Vector3d rotation(0.02, -0.03, 0.01), t(0.01, 0.02, 0.15);
  const Case c(rotation, t);
  const auto twist = c.twist(someChild());
  ASSERT_TRUE(twist);
  constexpr double kStep = 1e-5;
  Matrix6d by_step;
  for (int i = 0; i < 6; ++i) {
    Vector6d off = Vector6d::Zero();
    off[i] = kStep;
    const auto at = [&](double sign) {
      return byPoses(rotation + sign * off.head<3>(), t + sign * off.tail<3>(), someChild());
    };
    by_step.col(i) = (at(1) - at(-1)) / (2 * kStep);
  }
  const Matrix6d expected = by_step * c.step_covariance * by_step.transpose();
  EXPECT_NEAR((twist->covariance - expected).norm(), 0, 2e-3 * expected.norm());
}

TEST(BodyTwist, MayHaveChangedSinceTheMiddleOfTheStep) {
  const Case c({0, 0.01, 0}, {0, 0, 0.1});
  const Matrix6d more = c.twist(someChild(), 2)->covariance - c.twist(someChild())->covariance;
  // 2 m/s^2 for 25 ms, in all directions.
  const Eigen::Matrix3d expected = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR((more.topLeftCorner<3, 3>() - expected).norm(), 0, 1e-12);
  EXPECT_NEAR(more.bottomRows<3>().norm(), 0, 1e-15);
}

TEST(BodyTwist, IsNoneWithoutAVelocity) {
  Case c({0, 0.01, 0}, {0, 0, 0.1});
  c.camera.velocity.setConstant(kUnknown);
  EXPECT_FALSE(c.twist(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(bodyTwist(LandingResult(), kT, 1, Eigen::Isometry3d::Identity()));
  c = Case({0, 0.01, 0}, {0, 0, 0.1});
  EXPECT_FALSE(bodyTwist(c.camera, kUnknown, 1, Eigen::Isometry3d::Identity()));
}

}  // namespace
