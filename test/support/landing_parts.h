#pragma once

#include "integrity/tests/pair_tests.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/pair_input.h"
#include "support/kalman_height_inputs.h"
#include "support/rigs.h"

namespace uav_landing {
namespace test {

// Values that the parts of the landing estimate hand to each other, made by hand.

/// T: s since the pair before.
inline PairInput pairOf(const StereoDepthResult& stereo, const ApproachAngleResult& approach,
                        double T = kStep) {
  PairInput in(usualRig(), stereo, approach, true, true);
  in.T = T;
  return in;
}

/// A pair of which stereo says nothing.
inline PairInput pairOf(const ApproachAngleResult& approach, double T = kStep) {
  return pairOf(noStereo(approach.stamp), approach, T);
}

/// A straight flight of which only the step from the pair before is known: the angle is of that.
inline ApproachAngleResult stepAlone(double stamp) {
  ApproachAngleResult approach = withoutTurning(stamp);
  approach.window = {};
  return approach;
}

/// Ground that is this plane, by stereo alone, on all pairs so far.
inline Ground groundOf(const GroundPlane& plane) {
  Ground ground;
  ground.plane = ground.alone = plane;
  ground.surface.below = plane;
  ground.normal = {plane.normal(), plane.normalCovariance()};
  return ground;
}

inline MeasuredHeight measuredHeight(double height, double stddev = 0.01) {
  MeasuredHeight measured;
  measured.height = height;
  measured.variance = stddev * stddev;
  return measured;
}

/// A pair that gives no height.
inline MeasuredHeight noHeight() {
  MeasuredHeight measured;
  measured.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  return measured;
}

inline HeightFilter emptyFilter() {
  const KalmanHeightParameters parameters;
  return HeightFilter(parameters.acceleration_stddev, parameters.initial_speed_stddev, parameters.gate);
}

/// speed: up, m/s.
inline HeightFilter filterAt(double height, double stddev = 0.01, double speed = 0,
                             double speed_stddev = 0.01) {
  HeightFilter filter = emptyFilter();
  filter.initialise(height, stddev * stddev);
  filter.updateSpeed(speed, speed_stddev * speed_stddev);
  return filter;
}

/// A height that the pairs before agree on.
inline HeightPrior priorAt(double height, double stddev = 0.01, double speed = 0) {
  return {filterAt(height, stddev, speed), HeightTrack::kConfirmations};
}

inline HeightPrior noPrior() { return {emptyFilter(), 0}; }

/// After a pair whose height was accepted.
inline TrackVerdict trackingAt(const HeightFilter& filter) {
  TrackVerdict post(filter);
  post.status = Status::kTracking;
  post.confirmed = post.height_valid = true;
  post.height = filter.state()[0];
  post.height_variance = filter.covariance()(0, 0);
  return post;
}

inline PairTests noTests() {
  const KalmanHeightParameters parameters;
  return PairTests(parameters.false_alarm_rate, parameters.gate);
}

/// Tests of which this one failed, by ten sigmas.
inline PairTests failing(IntegrityTest test) {
  PairTests tests = noTests();
  tests.add(test, 10.0, 1.0);
  return tests;
}

/// "tilt image_regions", or "" when none failed.
inline std::string failedOf(const PairTests& tests) { return failedTests(FailureCounts().count(tests)); }

}  // namespace test
}  // namespace uav_landing
