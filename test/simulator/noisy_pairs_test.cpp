#include <gtest/gtest.h>

#include <cmath>

#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

/// A place 2 m above the ground where texture is coarse, which noise of 8 grey levels mostly covers.
SimulatorParameters lowOverCoarseTexture() {
  SimulatorParameters p;
  p.path.start_height = 2;
  p.path.start_x = 291.400289;
  p.path.duration = 0.1;
  p.random.seed = 22;
  return p;
}

/// Noise by which the plane of the corners is off by five of the sigmas that it claims: one pair of several
/// hundreds.
class NoisyPairs : public ::testing::TestWithParam<int> {};

TEST_P(NoisyPairs, AreNoMoreWrongThanTheyClaim) {
  constexpr double kNoise = 8;
  constexpr int kBefore = 4;  // pairs by which the plane is followed
  const ApproachSimulator simulator = ApproachSimulator::create(lowOverCoarseTexture()).value();
  const RigModel model =
      makeRigModel(simulator.rig().left.calibration, simulator.rig().right.calibration).value();
  StereoDepthParameters parameters;
  parameters.search_at_once = true;
  StereoDepthStage stage(model, parameters);
  ApproachSimulator::Light light = simulator.light(0);
  const double height = simulator.expose(light, kNoise).truth.height;
  StereoDepthResult result;
  for (int draw = GetParam() - kBefore; draw <= GetParam(); ++draw) {
    light.index = draw;  // which the noise is drawn by
    const ApproachSimulator::Frame frame = simulator.expose(light, kNoise);
    result = stage.process(draw, frame.left, frame.right);
    ASSERT_FALSE(result.failure) << result.failure.message();
  }
  EXPECT_NEAR(result.plane.height(), height, 4 * std::sqrt(result.plane.heightVariance()));
  EXPECT_NEAR(result.plane.height(), height, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Draws, NoisyPairs, ::testing::Values(414, 1205));

}  // namespace
}  // namespace uav_landing
