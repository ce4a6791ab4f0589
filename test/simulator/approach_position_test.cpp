#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// A flight over the beginning of the runway, degrees and metres.
struct Flight {
  const char* name;
  double y = 0, yaw = 0, roll = 0, pitch = -4, glide = 3.5;
};
void PrintTo(const Flight& flight, std::ostream* stream) { *stream << flight.name; }

SimulatorParameters parametersOf(const Flight& flight) {
  SimulatorParameters parameters;
  parameters.path.start_height = 12;
  parameters.path.start_x = -60;
  parameters.path.start_y = flight.y;
  parameters.path.duration = 0.5;
  parameters.path.rate = 20;
  parameters.path.speed = 20;
  parameters.path.flare_height = 0;
  parameters.path.glide_angle_deg = flight.glide;
  parameters.path.pitch_deg = flight.pitch;
  parameters.path.roll_deg = flight.roll;
  parameters.path.yaw_deg = flight.yaw;
  return parameters;
}

class ApproachPosition : public testing::TestWithParam<Flight> {};

TEST_P(ApproachPosition, AndAttitudeAreThoseOfTheSimulator) {
  const auto simulator = ApproachSimulator::create(parametersOf(GetParam()));
  ASSERT_TRUE(simulator) << simulator.error().message();
  auto chain = Pipeline::create(simulator->rig().left.calibration, simulator->rig().right.calibration, {});
  ASSERT_TRUE(chain) << chain.error().message();
  LandingResult last;
  Truth truth;
  for (int i = 0; i < simulator->frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator->frame(i);
    last = chain->process(100 + frame.time, frame.left, frame.right).landing;
    truth = frame.truth;
  }
  ASSERT_TRUE(last.valid()) << last.failure.message();
  EXPECT_NEAR(last.height, truth.height, 0.05);
  EXPECT_NEAR(last.approach_angle / kDegree, truth.approach_angle / kDegree, 0.3);
  EXPECT_NEAR(last.pitch / kDegree, truth.pitch / kDegree, 0.1);
  EXPECT_NEAR(last.roll / kDegree, truth.roll / kDegree, 0.1);
  ASSERT_TRUE(std::isfinite(last.y)) << "the runway was not found";
  EXPECT_NEAR(last.yaw / kDegree, truth.yaw / kDegree, 0.1);
  EXPECT_NEAR(last.y, truth.y, 0.5);
  EXPECT_LT(std::abs(last.y - truth.y), 4 * std::sqrt(last.y_variance));
  if (std::isfinite(last.width_height)) {
    EXPECT_LT(std::abs(last.width_height - truth.height), 4 * std::sqrt(last.width_height_variance));
  }
}

// The ground falls towards the threshold by half a degree, which nobody can see from above it.
TEST(ApproachHeights, AboveTheGroundBelowAndAboveTheRunway) {
  SimulatorParameters parameters = parametersOf({"over a slope"});
  parameters.path.start_x = -56;
  parameters.path.start_height = 10;
  parameters.path.duration = 3.2;
  parameters.wobble.roll_deg = parameters.wobble.pitch_deg = parameters.wobble.yaw_deg = 0;
  parameters.profile.slope_before_deg = -0.5;
  parameters.profile.change_start = -5;
  parameters.profile.change_length = 10;
  const auto simulator = ApproachSimulator::create(parameters);
  ASSERT_TRUE(simulator) << simulator.error().message();
  auto chain = Pipeline::create(simulator->rig().left.calibration, simulator->rig().right.calibration, {});
  ASSERT_TRUE(chain) << chain.error().message();
  int before = 0, behind = 0;  // the slope
  LandingResult last;
  for (int i = 0; i < simulator->frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator->frame(i);
    last = chain->process(100 + frame.time, frame.left, frame.right).landing;
    if (!std::isfinite(last.height_above_runway)) continue;
    const double x = frame.truth.x, ground = x < -5 ? -x * std::tan(0.5 * kDegree) : 0;
    EXPECT_LT(std::abs(last.height_above_runway - (frame.truth.height + ground)),
              3 * std::sqrt(last.height_above_runway_variance) + 0.03)
        << x;
    (x < -5 ? before : behind) += 1;
  }
  EXPECT_GE(before, 10);
  EXPECT_GE(behind, 5);
  EXPECT_LT(std::sqrt(last.height_above_runway_variance), 0.05) << "over the runway";
}

INSTANTIATE_TEST_SUITE_P(, ApproachPosition,
                         testing::Values(Flight{"straight"}, Flight{"left", 8}, Flight{"right", -8},
                                         Flight{"yaw_left", 0, 10}, Flight{"yaw_right", 0, -10},
                                         Flight{"roll_left", 0, 0, -10}, Flight{"roll_right", 0, 0, 10},
                                         Flight{"pitch_down", 0, 0, 0, -8}, Flight{"pitch_level", 0, 0, 0, 0},
                                         Flight{"flat", 0, 0, 0, -4, 2.2}, Flight{"steep", 0, 0, 0, -4, 6},
                                         Flight{"all_together", 5, -7, 8, -6, 5}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace uav_landing
