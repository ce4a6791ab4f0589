#include "geometry/ground_normal.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "some_plane.h"

namespace uav_landing {
namespace {

const double kNan = std::nan("");
const Eigen::Matrix3d kCovariance = 1e-4 * Eigen::Matrix3d::Identity();

template <class Type>
class UnitVector : public testing::Test {};
using Types = testing::Types<GroundNormal, GroundDirection>;
TYPED_TEST_SUITE(UnitVector, Types);

TYPED_TEST(UnitVector, KeepsWhatItIsMadeOf) {
  const Eigen::Vector3d unit(0.6, 0, 0.8);
  const TypeParam made(unit, kCovariance);
  EXPECT_EQ(made.vector(), unit);
  EXPECT_EQ(made.covariance(), kCovariance);
  EXPECT_TRUE(TypeParam::of(unit, kCovariance));
}

TYPED_TEST(UnitVector, IsNothingElse) {
  const Eigen::Vector3d unit(0, 1, 0);
  Eigen::Matrix3d unknown = kCovariance;
  unknown(0, 2) = kNan;
  const std::pair<Eigen::Vector3d, Eigen::Matrix3d> none[] = {{1.01 * unit, kCovariance},
                                                              {Eigen::Vector3d::Zero(), kCovariance},
                                                              {{0, kNan, 1}, kCovariance},
                                                              {unit, unknown}};
  for (const auto& [vector, covariance] : none) {
    EXPECT_FALSE(TypeParam::of(vector, covariance)) << vector.transpose();
    EXPECT_THROW(TypeParam(vector, covariance), std::invalid_argument) << vector.transpose();
  }
}

TEST(NormalOf, IsThatOfAPlaneIfThereIsOne) {
  const GroundPlane plane = somePlane();
  const std::optional<GroundNormal> normal = normalOf(plane);
  ASSERT_TRUE(normal);
  EXPECT_EQ(normal->vector(), plane.normal());
  EXPECT_EQ(normal->covariance(), plane.normalCovariance());
  EXPECT_FALSE(normalOf(GroundPlane()));
}

TEST(LevelDirections, LieInTheGroundAlsoForACameraThatLooksStraightDown) {
  for (const Eigen::Vector3d& down :
       {Eigen::Vector3d(0.1, 0.9, 0.3).normalized(), Eigen::Vector3d::UnitZ().eval()})
    for (const GroundDirection& level : levelDirections(GroundNormal(down, kCovariance)))
      EXPECT_NEAR(level.vector().dot(down), 0, 1e-12);
}

/// A direction off the ground by `slope`, and its covariance of 1 sigma `stddev`.
GroundDirection directionOff(const GroundPlane& plane, double slope, double stddev) {
  const Eigen::Vector3d n = plane.normal(), level = Eigen::Vector3d::UnitX().cross(n).normalized();
  const Eigen::Vector3d p = std::cos(slope) * level + std::sin(slope) * n;
  return {p, stddev * stddev * (Eigen::Matrix3d::Identity() - p * p.transpose())};
}

TEST(FuseDirection, GivesTheWeightedLeastSquaresPlane) {
  const GroundPlane plane = somePlane();
  const GroundDirection direction = directionOff(plane, 0.004, 0.002);
  double nis = -1;
  const GroundPlane fused = fuseDirection(plane, direction, 100, &nis);
  // Information form: both measurements side by side.
  const double noise = plane.g.dot(direction.covariance() * plane.g);
  const Eigen::Matrix3d information =
      plane.covariance.inverse() + direction.vector() * direction.vector().transpose() / noise;
  const Eigen::Vector3d expected = information.inverse() * (plane.covariance.inverse() * plane.g);
  EXPECT_TRUE(fused.g.isApprox(expected, 1e-9));
  EXPECT_TRUE(fused.covariance.isApprox(information.inverse(), 1e-9));
  const double innovation = direction.vector().dot(plane.g);
  EXPECT_NEAR(
      nis, innovation * innovation / (direction.vector().dot(plane.covariance * direction.vector()) + noise),
      1e-9);
  EXPECT_LT(std::abs(fused.g.dot(direction.vector())), std::abs(innovation));
}

TEST(FuseDirection, LeavesThePlaneWhenTheDirectionContradictsIt) {
  const GroundPlane plane = somePlane();
  const GroundDirection direction = directionOff(plane, 0.2, 0.002);
  double nis = 0;
  const GroundPlane fused = fuseDirection(plane, direction, 10, &nis);
  EXPECT_GT(nis, 10);
  EXPECT_EQ(fused.g, plane.g);
  EXPECT_EQ(fused.covariance, plane.covariance);
}

TEST(FuseNormal, GivesTheWeightedLeastSquaresPlane) {
  const GroundPlane plane = somePlane();
  // Level ground tipped by 0.01 in pitch and -0.02 in roll against the plane.
  const double stddev = 0.03;
  const Eigen::Vector3d normal = (plane.normal() + Eigen::Vector3d(-0.02, 0, 0.01)).normalized();
  const Eigen::Matrix3d covariance =
      stddev * stddev * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  double nis = -1;
  const GroundPlane fused = fuseNormal(plane, {normal, covariance}, 10, &nis);
  // Information form: what lies in the level ground has no inverse depth, to this sigma times 1 / h.
  const double noise = std::pow(stddev * normal.dot(plane.g), 2);
  const Eigen::Matrix3d information =
      plane.covariance.inverse() + (Eigen::Matrix3d::Identity() - normal * normal.transpose()) / noise;
  const Eigen::Vector3d expected = information.inverse() * (plane.covariance.inverse() * plane.g);
  EXPECT_LT((fused.g - expected).norm(), 1e-3 * (expected - plane.g).norm());
  EXPECT_TRUE(fused.covariance.isApprox(information.inverse(), 1e-3));
  EXPECT_GT(nis, 0);
}

TEST(FuseNormal, LeavesThePlaneWhenOneOfItsDirectionsContradictsIt) {
  const GroundPlane plane = somePlane();
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0.2, 0, 0), Eigen::Vector3d(0, 0, 0.2)}) {
    const Eigen::Vector3d normal = (plane.normal() + off).normalized();
    double nis = 0;
    const GroundPlane fused = fuseNormal(plane, {normal, 1e-6 * Eigen::Matrix3d::Identity()}, 10, &nis);
    EXPECT_GT(nis, 10);
    EXPECT_EQ(fused.g, plane.g);
    EXPECT_EQ(fused.covariance, plane.covariance);
  }
}

TEST(WeightedMean, IsThatOfPitchAndRollByThemselves) {
  // Pitch known by the second, roll by the first.
  const auto normal = [](double pitch, double roll, double pitch_stddev, double roll_stddev) {
    const Eigen::Vector3d n = normalFromPitchRoll(pitch, roll);
    const Eigen::Matrix3d level = n * n.transpose();
    Eigen::Matrix3d covariance =
        Eigen::Vector3d(std::pow(roll_stddev, 2), 0, std::pow(pitch_stddev, 2)).asDiagonal();
    covariance = (Eigen::Matrix3d::Identity() - level) * covariance * (Eigen::Matrix3d::Identity() - level);
    return GroundNormal{n, covariance};
  };
  const GroundNormal a = normal(0.010, 0.004, 0.02, 0.01), b = normal(-0.005, -0.008, 0.01, 0.03);
  const GroundNormal mean = weightedMean(a, b);
  EXPECT_NEAR(mean.vector().norm(), 1, 1e-12);
  EXPECT_NEAR(pitchOf(mean.vector()), (0.010 * 1 - 0.005 * 4) / 5, 1e-5);
  EXPECT_NEAR(rollOf(mean.vector()), (0.004 * 9 - 0.008 * 1) / 10, 1e-5);
  EXPECT_NEAR(std::sqrt(pitchVariance(mean.vector(), mean.covariance())), 0.02 / std::sqrt(5), 1e-5);
  EXPECT_NEAR(std::sqrt(rollVariance(mean.vector(), mean.covariance())), 0.03 / std::sqrt(10), 1e-5);
  EXPECT_NEAR(mean.vector().dot(mean.covariance() * mean.vector()), 0, 1e-12);
}

}  // namespace
}  // namespace uav_landing
