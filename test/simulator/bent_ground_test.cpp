#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

/// An approach over ground that is level before the threshold and then changes its slope by a degree.
SimulatorParameters overBend(double degrees) {
  SimulatorParameters p;
  p.path.duration = 6;
  p.path.rate = 1;
  p.path.speed = 20;
  p.path.start_x = -80;
  p.path.start_height = 11;
  p.path.glide_angle_deg = 3;
  p.path.flare_height = 0;
  p.profile.slope_after_deg = degrees;
  p.profile.change_length = 200;
  return p;
}

// By degrees, and whether the plane is refined directly: corners alone see less of a bend.
class BentGround : public ::testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(BentGround, HeightIsTheClearanceStraightBelow) {
  const auto [degrees, direct] = GetParam();
  const ApproachSimulator simulator = ApproachSimulator::create(overBend(degrees)).value();
  const RigModel model =
      makeRigModel(simulator.rig().left.calibration, simulator.rig().right.calibration).value();
  StereoDepthParameters parameters;
  parameters.direct_refinement = direct;
  parameters.search_at_once = true;
  StereoDepthStage stage(model, parameters);
  double ahead = 0, below = 0;
  for (int i = 0; i < simulator.frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator.frame(i);
    const StereoDepthResult result = stage.process(frame.time, frame.left, frame.right);
    // Corners alone are believed with the second pair.
    if (i == 0 && !direct) continue;
    ASSERT_FALSE(result.failure) << result.failure.message();
    ASSERT_TRUE(result.below.valid());
    EXPECT_NEAR(result.below.height(), frame.truth.height, 3 * std::sqrt(result.below.heightVariance())) << i;
    EXPECT_GT(result.curvature * degrees, 0) << i;
    EXPECT_GE(result.below.heightVariance(), result.plane.heightVariance()) << i;
    ahead += std::abs(result.plane.height() - frame.truth.height);
    below += std::abs(result.below.height() - frame.truth.height);
  }
  EXPECT_LT(below, 0.6 * ahead);
}

INSTANTIATE_TEST_SUITE_P(SagAndCrest, BentGround,
                         ::testing::Combine(::testing::Values(1.0, -1.0), ::testing::Bool()));

}  // namespace
}  // namespace uav_landing
