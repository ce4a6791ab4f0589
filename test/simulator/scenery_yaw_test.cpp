#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// How often the yaw is known after the first second, and how often it is more than a degree off at any time.
struct Score {
  int pairs = 0, known = 0, wrong = 0;
  double worst = 0;  // deg
};

/// The first seconds of a scene, while the runway is far away.
Score fly(const std::string& scene, double seconds) {
  Score score;
  auto parameters = loadSimulatorParameterFile(std::string(UAV_LANDING_SOURCE_DIR) +
                                               "/config/simulator/scenes/" + scene + ".yaml");
  if (!parameters) throw std::runtime_error(parameters.error().detail);
  parameters->path.duration = seconds;
  const auto simulator = ApproachSimulator::create(*parameters);
  if (!simulator) throw std::runtime_error(simulator.error().detail);
  auto chain = Pipeline::create(simulator->rig().left.calibration, simulator->rig().right.calibration, {});
  if (!chain) throw std::runtime_error(chain.error().message());
  for (int i = 0; i < simulator->frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator->frame(i);
    const LandingResult result = chain->process(100 + frame.time, frame.left, frame.right).landing;
    const double error = std::abs(result.yaw - frame.truth.yaw) / kDegree;
    if (std::isfinite(error)) score.worst = std::max(score.worst, error);
    score.wrong += error > 1 ? 1 : 0;
    if (frame.time <= 1) continue;
    ++score.pairs;
    score.known += std::isfinite(error) ? 1 : 0;
  }
  return score;
}

/// Scenes in which something else than the runway could be taken for it.
class SceneryYaw : public testing::TestWithParam<const char*> {};

TEST_P(SceneryYaw, IsThatOfTheRunwayAndIsKnownMostly) {
  const Score score = fly(GetParam(), 8);
  EXPECT_EQ(score.wrong, 0) << "off by up to " << score.worst << " degrees";
  EXPECT_GE(score.known, 0.8 * score.pairs);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneryYaw, testing::Values("shore", "airport", "nose"),
                         [](const auto& info) { return std::string(info.param); });

/// Where streets, crop rows or a hill outweigh the distant runway.
class SceneryDoubt : public testing::TestWithParam<const char*> {};

TEST_P(SceneryDoubt, NothingElseIsTakenForTheRunway) {
  const Score score = fly(GetParam(), 6);
  EXPECT_GT(score.pairs, 40);
  EXPECT_EQ(score.wrong, 0) << "off by up to " << score.worst << " degrees";
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneryDoubt, testing::Values("town", "fields", "hills"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace uav_landing
