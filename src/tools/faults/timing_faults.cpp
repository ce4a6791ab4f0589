#include <algorithm>

#include "faults/fault_lists.h"
#include "faults/fault_makers.h"

namespace uav_landing {

void addTimingFaults(std::vector<Fault>& all) {
  const auto frameOf = [](FaultRun& run, int frame) -> const Flight::Frame& {
    return run.flight.frames[static_cast<size_t>(std::max(0, frame))];
  };
  all.push_back(spoils(
      "frozen_left", Place::kTiming, "left camera repeats its last image",
      [=](FaultRun& run, int, Delivery& pair) { pair.left = frameOf(run, run.onset - 1).left.clone(); }));
  all.push_back(spoils(
      "frozen_right", Place::kTiming, "right camera repeats its last image",
      [=](FaultRun& run, int, Delivery& pair) { pair.right = frameOf(run, run.onset - 1).right.clone(); }));
  all.push_back(spoils("frozen_both", Place::kTiming, "both cameras repeat their last images",
                       [=](FaultRun& run, int, Delivery& pair) {
                         pair.left = frameOf(run, run.onset - 1).left.clone();
                         pair.right = frameOf(run, run.onset - 1).right.clone();
                       }));
  all.push_back(spoils("frozen_noisy", Place::kTiming, "left camera's scene stands still, its noise does not",
                       [=](FaultRun& run, int, Delivery& pair) {
                         pair.left = frameOf(run, run.onset - 1).left.clone();
                         addNoise(pair.left, 2, run.random);
                       }));
  all.push_back(spoils("swapped", Place::kTiming, "left and right exchanged",
                       [](FaultRun&, int, Delivery& pair) { std::swap(pair.left, pair.right); }));
  all.push_back(spoils("copied_right", Place::kTiming, "right image is the left one",
                       [](FaultRun&, int, Delivery& pair) { pair.right = pair.left.clone(); }));
  all.push_back(
      spoils("dropped", Place::kTiming, "every second pair missing at random",
             [](FaultRun& run, int, Delivery& pair) { pair.delivered = run.random.uniform(0, 2) == 0; }));
  all.push_back(spoils(
      "gap", Place::kTiming, "no pair for 0.6 s",
      [](FaultRun& run, int frame, Delivery& pair) { pair.delivered = sinceOnset(run, frame) > 0.6; }));
  all.push_back(
      spoils("late", Place::kTiming, "stamps late by up to 40 ms at random",
             [](FaultRun& run, int, Delivery& pair) { pair.time += run.random.uniform(0.0, 0.04); }));
  all.push_back(spoils("repeated", Place::kTiming, "every second pair is the one before once more",
                       [=](FaultRun& run, int frame, Delivery& pair) {
                         if ((frame - run.onset) % 2 != 0) return;
                         pair.left = frameOf(run, frame - 1).left.clone();
                         pair.right = frameOf(run, frame - 1).right.clone();
                       }));
  all.push_back(spoils("out_of_order", Place::kTiming, "every fourth pair comes after the one behind it",
                       [=](FaultRun& run, int frame, Delivery& pair) {
                         const int phase = (frame - run.onset) % 4;
                         const int other = phase == 0 ? frame + 1 : phase == 1 ? frame - 1 : frame;
                         if (other == frame || other >= static_cast<int>(run.flight.frames.size())) return;
                         const Flight::Frame& instead = frameOf(run, other);
                         pair.time = instead.time;
                         pair.left = instead.left.clone();
                         pair.right = instead.right.clone();
                       }));
  all.push_back(spoils(
      "unsynchronised", Place::kTiming, "right image is the one of the pair before",
      [=](FaultRun& run, int frame, Delivery& pair) { pair.right = frameOf(run, frame - 1).right.clone(); }));
  all.push_back(disturbed("clock_drift", "right camera exposes later and later, by 5 ms each second",
                          [](SimulatorParameters& p, double onset) {
                            p.right_camera.clock_drift = 0.005;
                            p.right_camera.clock_drift_start = onset;
                          }));
}

}  // namespace uav_landing
