#include <gtest/gtest.h>

#include <cmath>

#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

/// Mean over pairs and scenes, as it is by chance less than zero in some; share of the height, squared.
double meanSurfaceVariance(double height) {
  constexpr double kNoise = 1;  // grey levels
  constexpr int kPairs = 3;
  constexpr int kScenes = 6;
  double sum = 0;
  for (int scene = 0; scene < kScenes; ++scene) {
    SimulatorParameters p;
    p.path.start_height = height;
    p.path.start_x = -10 * height + 60 * scene;
    p.path.duration = 1;
    p.random.seed = 60 + scene;
    p.image.blur = 0.5;
    // What a calibration leaves: along a row, markings aslant seem moved.
    p.rig.lens_rows = scene % 2 == 0 ? 0.05 : -0.05;
    p.rig.lens_tilt_deg = scene % 3 == 0 ? 0.02 : -0.02;
    const ApproachSimulator simulator = ApproachSimulator::create(p).value();
    const RigModel model =
        makeRigModel(simulator.rig().left.calibration, simulator.rig().right.calibration).value();
    StereoDepthParameters parameters;
    parameters.search_at_once = true;
    StereoDepthStage stage(model, parameters);
    for (int pair = 0; pair < kPairs; ++pair) {
      const ApproachSimulator::Frame frame = simulator.expose(simulator.light(pair), kNoise);
      const StereoDepthResult result = stage.process(0.05 * pair, frame.left, frame.right);
      EXPECT_FALSE(result.failure) << result.failure.message();
      sum += result.surface_variance / std::pow(height, 2);
    }
  }
  return sum / (kPairs * kScenes);
}

// Corners of a marking are off together, as if the ground rose there by some thousandths of the height.
TEST(FlatSurface, IsNotTakenForUnevenGround) {
  EXPECT_NEAR(meanSurfaceVariance(10), 0, std::pow(0.0007, 2));
  EXPECT_NEAR(meanSurfaceVariance(20), 0, std::pow(0.0015, 2));
}

}  // namespace
}  // namespace uav_landing
