#include "rig/plane_rate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

/// A pair whose plane was carried to the stamp as if it did not move, by rows that are late by 8 ms.
StereoDepthResult pairOf(const Eigen::Vector3d& g, const Eigen::Vector3d& rate) {
  constexpr double kLate = 0.008;
  StereoDepthResult result;
  result.plane.g = result.below.g = g + kLate * rate;
  result.plane.covariance = result.below.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  result.plane_by_rate = -kLate * Eigen::Matrix3d::Identity();
  return result;
}

const Eigen::Vector3d kPlane = Eigen::Vector3d(0.05, 0.99, 0.1).normalized() / 5;
constexpr double kSecondOrder = 1e-4;  // of the plane: the square of what it is carried by
const RowMotion kMotion{{0.2, -0.05, 0.3}, {0.02, 0.3, 3}};

ApproachAngleResult::Motion stepOf(double duration) {
  ApproachAngleResult::Motion step;
  step.duration = duration;
  step.rotation = duration * kMotion.w;
  step.translation_over_height = duration * kMotion.v;
  step.covariance = Matrix6d::Zero();
  return step;
}

TEST(PlaneRate, OfABetterKnownMotionCorrectsThePlane) {
  const Eigen::Vector3d rate = planeRate(PlaneVector(kPlane), kMotion);
  StereoDepthResult pair = pairOf(kPlane, rate);
  EXPECT_GT((pair.plane.g - kPlane).norm(), 2e-3 * kPlane.norm());
  carryPlane(kMotion, {}, pair);
  EXPECT_LT((pair.plane.g - kPlane).norm(), kSecondOrder * kPlane.norm());
  EXPECT_LT((pair.below.g - kPlane).norm(), kSecondOrder * kPlane.norm());
  const Eigen::Vector3d once = pair.plane.g;
  carryPlane(kMotion, {}, pair);
  EXPECT_LT((pair.plane.g - once).norm(), kSecondOrder * kPlane.norm()) << "the rate is taken in already";
}

TEST(PlaneRate, IsThatOfTheTurnAtTheStampWhereItIsKnown) {
  StereoDepthResult pair = pairOf(kPlane, planeRate(PlaneVector(kPlane), kMotion));
  ApproachAngleResult::Motion step = stepOf(0.05);
  step.rotation *= 0.5;
  step.turn_rate = kMotion.w;
  carryPlane(step, {}, pair);
  EXPECT_LT((pair.plane.g - kPlane).norm(), kSecondOrder * kPlane.norm());
}

TEST(PlaneRate, IsAsUncertainAsTheStep) {
  StereoDepthResult pair = pairOf(kPlane, planeRate(PlaneVector(kPlane), kMotion)), exact = pair;
  ApproachAngleResult::Motion step = stepOf(0.05);
  carryPlane(step, {}, exact);
  EXPECT_LT((exact.plane.g - kPlane).norm(), kSecondOrder * kPlane.norm());
  // 1 mrad of the step's turn about the right axis is 20 mrad/s, of which 8 ms count.
  step.covariance(0, 0) = 1e-6;
  carryPlane(step, {}, pair);
  const Eigen::Vector3d tilt = Eigen::Vector3d::UnitX().cross(exact.plane.g).normalized();
  const double added = tilt.dot((pair.plane.covariance - exact.plane.covariance) * tilt);
  EXPECT_NEAR(std::sqrt(added), 0.02 * 0.008 * kPlane.norm(), 0.02 * 0.02 * 0.008 * kPlane.norm());
}

TEST(PlaneRate, IsAsUncertainAsItIsLargeWithoutAStep) {
  StereoDepthResult pair = pairOf(kPlane, Eigen::Vector3d::Zero());
  pair.plane_rate = {0, 0.1, 0};
  const Eigen::Vector3d before = pair.plane.g;
  carryPlane(ApproachAngleResult::Motion(), {}, pair);
  EXPECT_EQ(pair.plane.g, before);
  EXPECT_NEAR(std::sqrt(pair.plane.covariance(1, 1)), 0.008 * 0.1, 1e-5);
}

TEST(PlaneRate, ChangesNothingWithoutRowTimes) {
  StereoDepthResult pair = pairOf(kPlane, Eigen::Vector3d::Zero());
  pair.plane_by_rate.setZero();
  const GroundPlane before = pair.plane;
  carryPlane(stepOf(0.05), {}, pair);
  carryPlane(kMotion, {}, pair);
  EXPECT_EQ(pair.plane.g, before.g);
  EXPECT_EQ(pair.plane.covariance, before.covariance);
}

TEST(PlaneRate, ChangesNothingWhereTheShutterIsTakenAsGlobal) {
  StereoDepthResult pair = pairOf(kPlane, Eigen::Vector3d::Zero());
  pair.plane_by_rate = -0.25 * Eigen::Matrix3d::Identity();  // of a readout of 1 s
  pair.plane_rate = {0, 0.1, 0};
  const GroundPlane before = pair.plane;
  for (const ApproachAngleResult::Motion& step : {stepOf(0.05), ApproachAngleResult::Motion()}) {
    StereoDepthResult carried = pair;
    carryPlane(step, ReadoutEstimate::global(), carried);
    EXPECT_EQ(carried.plane.g, before.g);
    EXPECT_EQ(carried.plane.covariance, before.covariance);
  }
}

TEST(PlaneRate, ByAnEstimatedReadoutTimeCorrectsThePlaneAndClaimsItsError) {
  // Rows that are late by a quarter of a readout of 32 ms, which is given as one of 1 s.
  constexpr double kReadout = 0.032, kStddev = 0.004;
  const Eigen::Vector3d rate = planeRate(PlaneVector(kPlane), kMotion);
  StereoDepthResult pair = pairOf(kPlane, rate), by_stereo = pair, wide;
  pair.plane_by_rate = by_stereo.plane_by_rate = -0.25 * Eigen::Matrix3d::Identity();
  by_stereo.plane_rate = rate;  // was not carried by it
  wide = pair;
  carryPlane(kMotion, {kReadout, kStddev * kStddev}, pair);
  EXPECT_LT((pair.plane.g - kPlane).norm(), 2 * kSecondOrder * kPlane.norm());
  EXPECT_LT((pair.below.g - kPlane).norm(), 2 * kSecondOrder * kPlane.norm());
  const Eigen::Vector3d along = rate.normalized();
  const double claimed = std::sqrt(along.dot(pair.plane.covariance * along));
  EXPECT_NEAR(claimed, 0.25 * kStddev * rate.norm(), 0.02 * 0.25 * kStddev * rate.norm());
  EXPECT_NEAR(std::sqrt(along.dot(pair.row_covariance * along)), claimed, 0.01 * claimed)
      << "is the same in all pairs";
  carryPlane(stepOf(0.05), {0, kReadout * kReadout}, wide);
  EXPECT_EQ(wide.plane.g, pairOf(kPlane, rate).plane.g);
  EXPECT_GT(std::sqrt(along.dot(wide.plane.covariance * along)), 7.9 * claimed);
  carryPlane(ApproachAngleResult::Motion(), {kReadout, kStddev * kStddev}, by_stereo);
  EXPECT_LT((by_stereo.plane.g - kPlane).norm(), 2 * kSecondOrder * kPlane.norm());
  EXPECT_NEAR(std::sqrt(along.dot(by_stereo.plane.covariance * along)), claimed, 0.02 * claimed);
}

}  // namespace
}  // namespace uav_landing
