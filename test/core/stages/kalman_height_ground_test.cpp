#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "support/degree.h"
#include "support/kalman_height_inputs.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;
using test::noStereo;
using test::stereoAt;
using test::usualRig;
using test::withoutTurning;

TEST(KalmanHeightGround, ABadPairDoesNotEraseWhatIsKnownOfTheGround) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto noStamp = [&](KalmanHeightStage& stage, double) {
    return stage.process(stereoAt(nan, 10), withoutTurning(nan));
  };
  const auto noMotion = [&](KalmanHeightStage& stage, double stamp) {
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.step.rotation.setConstant(nan);
    approach.step.translation_over_height.setConstant(nan);
    return stage.process(stereoAt(stamp, 10), approach);
  };
  const auto noPlane = [&](KalmanHeightStage& stage, double stamp) {
    StereoDepthResult stereo = stereoAt(stamp, 10);
    stereo.plane.g.setConstant(nan);
    return stage.process(stereo, withoutTurning(stamp));
  };
  const std::vector<std::function<LandingResult(KalmanHeightStage&, double)>> bad = {noStamp, noMotion,
                                                                                     noPlane};
  for (size_t i = 0; i < bad.size(); ++i) {
    KalmanHeightStage stage(usualRig(), {});
    double stamp = 0;
    for (; stamp < 1; stamp += kStep) stage.process(stereoAt(stamp, 10), withoutTurning(stamp));
    bad[i](stage, stamp);
    if (i > 0) stamp += kStep;
    const LandingResult result =
        stage.process(stereoAt(stamp, 10.02, -0.1, 0.05 + 4 * kDegree), withoutTurning(stamp));
    EXPECT_NE(failedTests(result.tests).find("tilt"), std::string::npos) << i;
  }
}

TEST(KalmanHeightGround, AVerticalSpeedThatIsRefusedDoesNotWidenTheProtectionLevel) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0, before = 0;
  for (; stamp < 1; stamp += kStep)
    before = stage.process(stereoAt(stamp, 10), withoutTurning(stamp)).height_protection_level;
  for (const double climb : {0.12, 0.12, 0.0, 0.0, 0.0, 0.0}) {  // of 10 m in 0.05 s: 24 m/s
    ApproachAngleResult approach = withoutTurning(stamp);
    approach.step.translation_over_height.y() = -climb;
    const LandingResult result = stage.process(stereoAt(stamp, 10), approach);
    EXPECT_NEAR(result.height_protection_level, before, 0.1) << result.protection_source;
    stamp += kStep;
  }
}

/// A pair over level ground, with the points that it is seen by.
StereoDepthResult overGround(double stamp) {
  const StereoRig rig = usualRig();
  StereoDepthResult stereo = stereoAt(stamp, 10);
  for (int v = 200; v < 480; v += 10) {
    for (int u = 10; u < 640; u += 20) {
      const double disparity = stereo.plane.disparity(rig, u, v);
      if (disparity > 2) stereo.points.push_back({double(u), double(v), disparity, 0.1, true});
    }
  }
  return stereo;
}

/// The motion along it, at 20 m/s.
ApproachAngleResult alongGround(double stamp) {
  ApproachAngleResult approach = withoutTurning(stamp);
  const Eigen::Vector3d n = stereoAt(stamp, 10).plane.normal();
  approach.step.translation_over_height = 0.2 * (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
  return approach;
}

TEST(KalmanHeightGround, ATurnOfAMotionThatFailedDoesNotLiftTheGroundBelow) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  LandingResult before;
  for (; stamp < 3; stamp += kStep) before = stage.process(overGround(stamp), alongGround(stamp));
  ASSERT_TRUE(before.height_valid) << before.failure.message();
  ApproachAngleResult failed = alongGround(stamp);
  failed.step.failure = {Reason::kMotionInconsistent, "3 of 300 matches agree"};
  failed.step.rotation.x() = -0.1;
  stage.process(overGround(stamp), failed);
  stamp += kStep;
  for (const double end = stamp + 1; stamp < end; stamp += kStep) {
    const LandingResult result = stage.process(overGround(stamp), alongGround(stamp));
    // The turn of that pair is not known, but by the normals before and after it; 0.1 rad would be metres.
    EXPECT_LT(result.height_protection_level, before.height_protection_level + 0.4)
        << result.protection_source;
  }
}

TEST(KalmanHeightGround, APairThatSeesNothingDoesNotNarrowTheProtectionLevelOverAnotherSurfaceBelow) {
  KalmanHeightStage stage(usualRig(), {});
  double stamp = 0;
  LandingResult before;
  for (; stamp < 3; stamp += kStep) {
    StereoDepthResult stereo = overGround(stamp);
    for (StereoDepthResult::Point& point : stereo.points) point.disparity /= 1.03;  // 0.3 m lower
    before = stage.process(stereo, alongGround(stamp));
  }
  ASSERT_EQ(before.protection_source, "surface_below");
  ASSERT_GT(before.height_protection_level, 0.3);
  ApproachAngleResult blind = alongGround(stamp);
  blind.n.setConstant(std::numeric_limits<double>::quiet_NaN());
  blind.step = {};
  blind.step.failure = {Reason::kNoGroundNormal, "nothing is seen"};
  const LandingResult result = stage.process(noStereo(stamp), blind);
  EXPECT_EQ(result.protection_source, "surface_below");
  EXPECT_GT(result.height_protection_level, before.height_protection_level - 0.02);
}

}  // namespace
}  // namespace uav_landing
