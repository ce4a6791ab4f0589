// A correct chart makes no output worse: random runways, each flown with their width and length given and
// without.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulation/random_approach.h"
#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
struct Output {
  const char* name;
  bool from_threshold;  // known from there on without a chart, which these flights do not reach
};
constexpr std::array<Output, 6> kOutputs{{{"height", false},
                                          {"angle", false},
                                          {"yaw", false},
                                          {"x", true},
                                          {"y", false},
                                          {"height above the runway", true}}};
using Errors = std::array<double, kOutputs.size()>;  // NaN where an output is not known

/// The last seconds of a far approach, seen by small images.
SimulatorParameters lastSeconds(uint64_t seed, double seconds) {
  SimulatorParameters p = drawFarApproach(seed);
  p.setPictures(320, 240, 277);
  p.profile = {};
  SimulatedPathParameters& path = p.path;
  const double before = path.duration - seconds, glide = path.glide_angle_deg * kDegree;
  const double way = path.speed * std::cos(glide) * before;
  path.start_x += way * std::cos(path.track_deg * kDegree);
  path.start_y += way * std::sin(path.track_deg * kDegree);
  path.start_height -= path.speed * std::sin(glide) * before;
  path.duration = seconds;
  return p;
}

Errors errorsOf(const LandingResult& landing, const Truth& truth) {
  const double angle = landing.angle_valid ? landing.approach_angle - truth.approach_angle : kUnknown;
  const double height = landing.height_valid ? landing.height - truth.height : kUnknown;
  return {height,
          angle,
          std::remainder(landing.yaw - truth.yaw, 2 * M_PI),
          landing.x - truth.x,
          landing.y - truth.y,
          landing.height_above_runway_known ? landing.height_above_runway - truth.height : kUnknown};
}

/// What is known of one output with the chart and without, over all flights.
struct Comparison {
  int with = 0, without = 0, both = 0;
  double square_with = 0, square_without = 0;

  void take(double error_with, double error_without) {
    const bool known_with = std::isfinite(error_with), known_without = std::isfinite(error_without);
    with += known_with;
    without += known_without;
    if (!known_with || !known_without) return;
    ++both;
    square_with += error_with * error_with;
    square_without += error_without * error_without;
  }
};

TEST(Chart, ACorrectOneMakesNoOutputWorse) {
  std::array<Comparison, kOutputs.size()> compared;
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const SimulatorParameters drawn = lastSeconds(seed, 2.5);
    const auto simulator = ApproachSimulator::create(drawn);
    ASSERT_TRUE(simulator) << simulator.error().message();
    const CameraRig& rig = simulator->rig();
    Parameters without;
    without.stereo_depth.search_at_once = without.approach_angle.search_at_once = true;
    Parameters with = without;
    with.runway.width = drawn.runway.width;
    with.runway.length = drawn.runway.length;
    auto told = Pipeline::create(rig.left.calibration, rig.right.calibration, with);
    auto untold = Pipeline::create(rig.left.calibration, rig.right.calibration, without);
    ASSERT_TRUE(told && untold);
    for (int i = 0; i < simulator->frames(); ++i) {
      const ApproachSimulator::Frame frame = simulator->frame(i);
      const double stamp = 100 + frame.time;
      const Errors a = errorsOf(told->process(stamp, frame.left, frame.right).landing, frame.truth);
      const Errors b = errorsOf(untold->process(stamp, frame.left, frame.right).landing, frame.truth);
      for (size_t k = 0; k < kOutputs.size(); ++k) compared[k].take(a[k], b[k]);
    }
  }
  for (size_t k = 0; k < kOutputs.size(); ++k) {
    const Comparison& c = compared[k];
    const char* name = kOutputs[k].name;
    EXPECT_GT(c.both, kOutputs[k].from_threshold ? -1 : 20) << name << ": too little is known to compare it";
    // A limit may be crossed a frame earlier or later.
    EXPECT_GE(c.with, 0.98 * c.without) << name;
    EXPECT_LE(std::sqrt(c.square_with), 1.1 * std::sqrt(c.square_without) + 1e-9)
        << name << " over " << c.both << " frames";
  }
}

}  // namespace
}  // namespace uav_landing
