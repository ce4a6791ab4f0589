#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// The scenes in which something else than the runway could be taken for it.
class SceneryYaw : public testing::TestWithParam<const char*> {};

TEST_P(SceneryYaw, IsThatOfTheRunwayWhereItIsKnownAndIsKnownMostly) {
  auto parameters = loadSimulatorParameterFile(std::string(UAV_LANDING_SOURCE_DIR) +
                                               "/config/simulator/scenes/" + GetParam() + ".yaml");
  ASSERT_TRUE(parameters) << parameters.error().detail;
  parameters->path.duration = 8;  // while the runway is far away
  const auto simulator = ApproachSimulator::create(*parameters);
  ASSERT_TRUE(simulator) << simulator.error().detail;
  auto chain = Pipeline::create(simulator->rig().left.calibration, simulator->rig().right.calibration, {});
  ASSERT_TRUE(chain) << chain.error().message();
  int pairs = 0, known = 0, wrong = 0;
  double worst = 0;
  for (int i = 0; i < simulator->frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator->frame(i);
    const LandingResult result = chain->process(100 + frame.time, frame.left, frame.right).landing;
    const double error = std::abs(result.yaw - frame.truth.yaw) / kDegree;
    if (std::isfinite(error)) worst = std::max(worst, error);
    wrong += error > 1 ? 1 : 0;  // at any time
    if (frame.time <= 1) continue;
    ++pairs;
    known += std::isfinite(error) ? 1 : 0;
  }
  RecordProperty("known", known);
  RecordProperty("worst_mdeg", static_cast<int>(1000 * worst));
  EXPECT_EQ(wrong, 0) << "off by up to " << worst << " degrees";
  EXPECT_GE(known, 0.8 * pairs);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneryYaw, testing::Values("shore", "airport", "hills", "nose"),
                         [](const auto& info) { return std::string(info.param); });
// Rows of houses and fields are taken for the runway in these.
INSTANTIATE_TEST_SUITE_P(DISABLED_OpenScenes, SceneryYaw, testing::Values("town", "fields"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace uav_landing
