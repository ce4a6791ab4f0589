#include "lines/segments/heading_gate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using namespace test;

constexpr double kMaxYaw = 30 * kDegree;

/// A line on the ground through this place (m, ahead and left of the camera), at an angle to the trace of the
/// optical axis, as the left camera sees it.
Eigen::Vector3d seen(const StereoRig& rig, const Pose& pose, double ahead, double aside, double heading) {
  const Eigen::Matrix3d R = pose.worldFromOptical();
  const double trace = std::atan2(R(1, 2), R(0, 2));
  const auto pixel = [&](double along) -> Eigen::Vector3d {
    const double azimuth = trace + heading;
    const Eigen::Vector3d place =
        Eigen::AngleAxisd(trace, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(ahead, aside, 0) +
        along * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0);
    return rig.K() * (R.transpose() * (place - pose.position));
  };
  return pixel(0).cross(pixel(1));
}

TEST(HeadingGate, PassesLinesWhoseDirectionOnTheGroundIsNearTheOpticalAxis) {
  const StereoRig rig = makeRig(640, 480, 0.5);
  for (const double roll : {-12.0, 0.0, 9.0}) {
    Pose pose = makePose(4, -7, roll);
    pose.yaw = 11 * kDegree;
    const HeadingGate gate(rig.K(), pose.down(), kMaxYaw);
    for (const double ahead : {10.0, 60.0})
      for (const double aside : {-9.0, 0.5, 14.0})
        for (const double sign : {-1.0, 1.0}) {
          for (const double heading : {0.0, 20.0, 30.0, 34.0})
            EXPECT_TRUE(gate.passes(-3 * seen(rig, pose, ahead, aside, sign * heading * kDegree))) << heading;
          for (const double heading : {36.5, 50.0, 80.0, 90.0})
            EXPECT_FALSE(gate.passes(seen(rig, pose, ahead, aside, sign * heading * kDegree))) << heading;
        }
  }
}

TEST(HeadingGate, LetsNothingAcrossPassHoweverWideItIs) {
  const StereoRig rig = makeRig(640, 480, 0.5);
  const Pose pose = makePose(4, -7, 0);
  const HeadingGate gate(rig.K(), pose.down(), 89 * kDegree);
  EXPECT_TRUE(gate.passes(seen(rig, pose, 20, 1, 80 * kDegree)));
  EXPECT_FALSE(gate.passes(seen(rig, pose, 20, 1, 89 * kDegree)));
}

}  // namespace
}  // namespace uav_landing
