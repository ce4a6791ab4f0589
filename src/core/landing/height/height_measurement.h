#pragma once

#include "height/width_height.h"
#include "integrity/tests/stamp_scatter.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// Height from the ground plane, or the average of eq (5) over the points (parameter height_source). Its
/// variance contains the errors of the surface. Fails as the ground does, or when there is nothing to
/// average, or when the height is not above the ground.
MeasuredHeight heightByGround(const StereoRig& rig, const KalmanHeightParameters& parameters,
                              const PairInput& in, const Ground& ground);

/// Height of a pair from all its sources: the ground and the runway's width. It also accounts for errors of
/// the stamps.
class HeightMeasurement {
 public:
  /// baseline_stddev: 1 sigma of the baseline's length, as a share of it.
  HeightMeasurement(const StereoRig& rig, const KalmanHeightParameters& parameters,
                    const RunwayParameters& runway = {}, double baseline_stddev = 0);

  /// by_ground: height of the same pair. The result has no failure when the width alone gives a height.
  MeasuredHeight propose(const PairInput& in, const Ground& ground, const MeasuredHeight& by_ground,
                         const HeightPrior& prior);
  /// Call it after the verdict of the track. It learns the runway's width from a height that was accepted.
  void commit(const PairInput& in, const Ground& ground, const MeasuredHeight& measured, bool accepted);
  /// Variance of the durations between stamps, divided by their squares.
  double durationVariance() const { return stamps_.ofDuration(); }
  bool widthKnown() const { return width_.independent(); }

 private:
  void followStamps(const PairInput& in, const HeightPrior& prior, MeasuredHeight& measured);
  void useWidth(const ApproachAngleResult::Runway& runway, const Ground& ground, const HeightPrior& prior,
                MeasuredHeight& measured);
  void leaveOutSources(const PairInput& in, const Ground& ground, MeasuredHeight& measured) const;
  void leaveOutRegions(const PairInput& in, const Ground& ground, MeasuredHeight& measured) const;

  StereoRig rig_;
  KalmanHeightParameters parameters_;
  double baseline_stddev_;
  WidthHeight width_;
  StampScatter stamps_;
};

}  // namespace uav_landing
