#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "uav_landing/pipeline.h"
#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

constexpr double kRate = 20;  // Hz

/// Low over the runway, with small pictures and noise.
SimulatorParameters lowPass() {
  SimulatorParameters p;
  p.setPictures(320, 240, 277);
  p.path.rate = kRate;
  p.path.speed = 20;
  p.path.start_x = -40;
  p.path.flare_height = 0;
  p.wobble.heave = 0;
  return p;
}

/// 5 degrees, falling to 0.5 within 3 s from 1.5 s on, then level for a second.
SimulatorParameters flare() {
  SimulatorParameters p = lowPass();
  p.path.start_height = 10;
  p.path.glide_angle_deg = 5;
  p.path.flare_height = 10 - 1.5 * 20 * std::sin(5 * M_PI / 180);
  p.path.flare_duration = 3;
  p.path.flare_angle_deg = 0.5;
  p.path.duration = 5.5;
  return p;
}

/// A gust of 2 s that takes the path from 4 degrees to 8.5 and back.
SimulatorParameters gust() {
  SimulatorParameters p = lowPass();
  p.path.start_height = 14;
  p.path.glide_angle_deg = 4;
  p.path.duration = 5;
  p.gust.speed = 1.6;
  p.gust.start = 1.5;
  p.gust.duration = 2;
  return p;
}

Pipeline pipelineWith(AngleSmoothing smoothing, const ApproachSimulator& simulator) {
  Parameters parameters;
  parameters.approach_angle.angle_smoothing = smoothing;
  return Pipeline::create(simulator.rig().left.calibration, simulator.rig().right.calibration, parameters)
      .value();
}

/// Angles of all frames later than 1 s, true and published (invalid frames: none).
struct Angles {
  std::vector<double> truth, adaptive, chord;
};
Angles fly(const SimulatorParameters& p) {
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  Pipeline adaptive = pipelineWith(AngleSmoothing::kAdaptive, simulator),
           chord = pipelineWith(AngleSmoothing::kChord, simulator);
  Angles angles;
  for (int i = 0; i < simulator.frames(); ++i) {
    const ApproachSimulator::Frame frame = simulator.frame(i);
    const auto published = [&](Pipeline& pipeline) {
      const LandingResult landing = pipeline.process(100 + frame.time, frame.left, frame.right).landing;
      EXPECT_TRUE(frame.time <= 1 || landing.angle_valid)
          << frame.time << " s: " << landing.failure.message();
      return landing.approach_angle;
    };
    const double now = published(adaptive), late = published(chord);
    if (frame.time <= 1) continue;
    angles.truth.push_back(frame.truth.approach_angle);
    angles.adaptive.push_back(now);
    angles.chord.push_back(late);
  }
  return angles;
}

/// Delay of the truth that explains the published angles best (least squares), s. Negative: they are early.
double lagOf(const std::vector<double>& published, const std::vector<double>& truth) {
  constexpr int kMost = 10;  // frames
  const int count = static_cast<int>(truth.size());
  double best = 0, least = 1e300;
  for (double frames = -kMost; frames <= kMost; frames += 0.1) {
    double sum = 0;
    for (int i = kMost; i + kMost + 1 < count; ++i) {
      const double at = i - frames;
      const int before = static_cast<int>(std::floor(at));
      const double share = at - before;
      const double delayed = (1 - share) * truth[before] + share * truth[before + 1];
      sum += std::pow(published[i] - delayed, 2);
    }
    if (sum >= least) continue;
    least = sum;
    best = frames;
  }
  return best / kRate;
}

class LagTest : public testing::TestWithParam<SimulatorParameters (*)()> {};

// A quarter of a second is allowed. What a mean over half a second has, 0.225 s, is the yardstick for the
// test itself: the adaptive filter must do much better, or it is of no use.
TEST_P(LagTest, PublishedAngleIsThatOfNow) {
  const Angles angles = fly(GetParam()());
  const double lag = lagOf(angles.adaptive, angles.truth);
  EXPECT_LT(lag, 0.1) << "s";
  EXPECT_GT(lag, -0.1) << "s";
  EXPECT_NEAR(lagOf(angles.chord, angles.truth), 0.225, 0.06) << "s, half of the chord's window";
}

INSTANTIATE_TEST_SUITE_P(Paths, LagTest, testing::Values(flare, gust),
                         [](const auto& info) { return info.index == 0 ? "Flare" : "Gust"; });

}  // namespace
}  // namespace uav_landing
