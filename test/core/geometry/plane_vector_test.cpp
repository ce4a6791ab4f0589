#include "geometry/plane_vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/rigs.h"

namespace uav_landing {
namespace {

TEST(PlaneVector, HasHeightNormalAndDisparities) {
  const StereoRig rig = test::usualRig();
  const PlaneVector plane(Eigen::Vector3d(0, 0.6, 0.8) / 20);
  EXPECT_NEAR(plane.height(), 20, 1e-12);
  EXPECT_TRUE(plane.normal().isApprox(Eigen::Vector3d(0, 0.6, 0.8), 1e-12));
  // On the optical axis this ground is 20 m / 0.8 away.
  EXPECT_NEAR(plane.disparity(rig, rig.cx, rig.cy), rig.fb() / 25, 1e-9);
}

TEST(PlaneVector, IsNothingElse) {
  const double nan = std::nan("");
  for (const Eigen::Vector3d& none :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, nan, 0), Eigen::Vector3d(0, 0.1, INFINITY)}) {
    EXPECT_FALSE(PlaneVector::of(none)) << none.transpose();
    EXPECT_THROW(PlaneVector{none}, std::invalid_argument) << none.transpose();
  }
}

TEST(PlaneVector, SaysWhichVectorHasNoPlane) {
  try {
    PlaneVector(Eigen::Vector3d(0, INFINITY, 0.5));
    FAIL() << "made a plane of it";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("0 inf 0.5"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace uav_landing
