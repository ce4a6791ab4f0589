#include "stereo/plane/region_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/ground_matches.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(RegionPlanes, APlaneWithoutTheWrongHalfIsRight) {
  const StereoRig rig = test::usualRig();
  const Eigen::Vector3d g = normalFromPitchRoll(-4 * kDegree, 0) / 10;
  std::vector<StereoDepthResult::Point> points = test::matchesOn(rig, g);
  // Left of the middle all disparities are too large by a share: a height too low by a twentieth.
  for (StereoDepthResult::Point& point : points)
    if (point.u < 310) point.disparity *= 1.02;
  const RegionPlanes planes = planesWithoutRegions(rig, points, PlaneVector(g));
  const auto heightWithout = [&](ImageRegion region) {
    return planes.without[static_cast<int>(region)].height();
  };
  EXPECT_NEAR(heightWithout(ImageRegion::kLeft), 10, 0.03);
  EXPECT_NEAR(heightWithout(ImageRegion::kRight), 10 / 1.02, 0.03);
  EXPECT_GT(planes.without[static_cast<int>(ImageRegion::kNear)].heightVariance(),
            planes.all.heightVariance());
}

TEST(RegionPlanes, NothingIsClaimedWithoutPoints) {
  const RegionPlanes planes = planesWithoutRegions(test::usualRig(), {}, PlaneVector({0, 0.1, 0}));
  EXPECT_FALSE(planes.all.valid());
  for (const GroundPlane& plane : planes.without) EXPECT_FALSE(plane.valid());
}

}  // namespace
}  // namespace uav_landing
