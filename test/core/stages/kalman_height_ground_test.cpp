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

}  // namespace
}  // namespace uav_landing
