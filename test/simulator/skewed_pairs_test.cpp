// Cameras that do not take their pictures at the same time, with stamps that say so and with stamps that do
// not.
#include <gtest/gtest.h>

#include "integrity/tests/test_catalogue.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

constexpr double kTick = 0.005;          // s, between the simulated pictures
constexpr int kTicks = 10, kPairs = 36;  // of a pair, and how many

SimulatorParameters approach() {
  SimulatorParameters p;
  p.setPictures(320, 240, 277);
  p.path.rate = 1 / kTick;
  p.path.speed = 20;
  p.path.start_x = -60;
  p.path.start_height = 10;
  p.path.duration = kTick * kTicks * (kPairs + 1);
  return p;
}

struct Counts {
  int valid = 0, contradicted = 0;
};

/// late: of the right picture, ticks. told: the stamps say so.
Counts fly(int late, bool told) {
  const ApproachSimulator simulator = ApproachSimulator::create(approach()).value();
  Pipeline pipeline =
      Pipeline::create(simulator.rig().left.calibration, simulator.rig().right.calibration, {}).value();
  Counts counts;
  for (int i = 0; i < kPairs; ++i) {
    const ApproachSimulator::Frame left = simulator.frame(i * kTicks);
    const ApproachSimulator::Frame right = simulator.frame(i * kTicks + late);
    const LandingResult& landing =
        pipeline.process(100 + left.time, left.left, right.right, told ? late * kTick : 0).landing;
    counts.valid += landing.height_valid;
    counts.contradicted += landing.tests[static_cast<int>(IntegrityTest::kBaselineDirection)].failed();
  }
  return counts;
}

TEST(SkewedPairs, AreNoFaultWhereTheStampsTell) {
  // 10 cm of way, on a metre of baseline.
  const Counts counts = fly(1, true);
  EXPECT_EQ(counts.contradicted, 0);
  EXPECT_GT(counts.valid, 25);
  // Twice as much is too uncertain for a height, but contradicts nothing.
  EXPECT_EQ(fly(2, true).contradicted, 0);
}

TEST(SkewedPairs, ContradictWhereTheStampsDoNot) {
  const Counts counts = fly(6, false);
  EXPECT_GT(counts.contradicted, 30);
  EXPECT_EQ(counts.valid, 0);
}

}  // namespace
}  // namespace uav_landing
