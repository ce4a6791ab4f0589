#include <gtest/gtest.h>

#include <cmath>

#include "simulation/random_approach.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

// Lines along the runway agree with any speed, and hold the motion near where it is looked for. Here, at
// 28.5 m/s and 4 m over hardly anything else, under much noise, a tenth of the speed was taken for it.
TEST(FastLowPass, IsNotTakenForASlowOneWhereLinesAreMostOfWhatThereIs) {
  constexpr double kDegree = M_PI / 180, kNoise = 5;
  constexpr uint64_t kFewMarkings = 377000000 + 377 * 3 + 300;
  const SimulatorParameters drawn = drawSnippet(kFewMarkings, 3, 13, {});
  ASSERT_GT(drawn.path.speed, 25);
  const ApproachSimulator simulator = ApproachSimulator::create(drawn).value();
  Pipeline pipeline =
      Pipeline::create(simulator.rig().left.calibration, simulator.rig().right.calibration, {}).value();
  int valid = 0;
  for (int i = 0; i < simulator.frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator.expose(simulator.light(i), kNoise);
    const LandingResult landing = pipeline.process(100 + frame.time, frame.left, frame.right).landing;
    if (!landing.angle_valid) continue;
    ++valid;
    const double error = landing.approach_angle - frame.truth.approach_angle;
    EXPECT_LT(std::abs(error), 0.1 * kDegree + 4 * std::sqrt(landing.approach_angle_variance))
        << "pair " << i << ": " << landing.approach_angle / kDegree << " degrees for "
        << frame.truth.approach_angle / kDegree;
  }
  EXPECT_GT(valid, simulator.frames() / 2);
}

}  // namespace
}  // namespace uav_landing
