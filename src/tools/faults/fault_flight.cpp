#include "faults/fault_flight.h"

#include <cmath>

#include "integrity/tests/stamp_order.h"
#include "uav_landing/geometry/camera_pair.h"
#include "uav_landing/pipeline.h"

namespace uav_landing {
namespace {

constexpr double kStart = 100;  // stamp of the first pair, s

/// in_flight: first frame with the faults that begin in flight.
Delivery deliver(FaultRun& run, const FaultCombination& faults, int in_flight, int frame) {
  const Flight::Frame& source = run.flight.frames[static_cast<size_t>(frame)];
  Delivery pair{source.time, source.left.clone(), source.right.clone(), true};
  for (const Fault* fault : faults) {
    run.onset = fault->from_first ? 0 : in_flight;
    if (fault->spoil && frame >= run.onset) fault->spoil(run, frame, pair);
  }
  return pair;
}

}  // namespace

FaultScore flyWithFaults(const Flight& flight, const FaultCombination& faults, int in_flight, int onset,
                         uint64_t seed, const Parameters& parameters, const FaultObserver& observe) {
  CameraCalibration left = flight.left, right = flight.right;
  Parameters told = parameters;
  for (const Fault* fault : faults) {
    if (fault->calibrate) fault->calibrate(left, right);
    if (fault->tell) fault->tell(told, flight);
  }
  FaultScore score;
  Expected<Pipeline> pipeline = workingPair(left, right, told.rig).and_then([&](const CameraPair& working) {
    return Pipeline::create(working.left, working.right, told);
  });
  if (!pipeline) {
    score.alarm = "refused: " + pipeline.error().detail;
    return score;
  }
  FaultRun run{flight, in_flight, cv::RNG(seed), seed};
  double last = flight.frames.front().time;
  StampOrder order(told.rectify.max_late);
  for (int frame = 0; frame < static_cast<int>(flight.frames.size()); ++frame) {
    const Delivery pair = deliver(run, faults, in_flight, frame);
    const double now = flight.frames[static_cast<size_t>(frame)].time;
    // Without a pair nothing is published. The last estimate gets as old as max_age at most, and is then
    // lost.
    if (!pair.delivered) continue;
    // Stamps are checked in the same way as where images are paired.
    if (!StampOrder::isUsed(order.follow(std::llround(1e9 * (kStart + pair.time))))) continue;
    const bool exchanged = told.rig.upside_down;
    const Pipeline::Output& output = pipeline->process(kStart + pair.time, exchanged ? pair.right : pair.left,
                                                       exchanged ? pair.left : pair.right);
    if (now - flight.frames.front().time < flight.settled) continue;
    const FaultTruth truth = truthAt(flight, pair.time);
    score.take(output.landing, truth, frame >= onset, now - last);
    if (observe) observe(now, output.landing, truth, frame >= onset);
    last = now;
  }
  return score;
}

}  // namespace uav_landing
