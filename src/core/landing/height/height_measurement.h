#pragma once

#include "height/width_height.h"
#include "integrity/stamp_scatter.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "uav_landing/parameters/runway_parameters.h"

namespace uav_landing {

/// The height of the plane, or the average of eq (5) over the points; what the surface is wrong by included.
MeasuredHeight heightByGround(const StereoRig& rig, const KalmanHeightParameters& parameters,
                              const PairInput& in, const Ground& ground);

/// The height by all that a pair has: the ground, the runway's width, and the time that the stamps leave
/// open.
class HeightMeasurement {
 public:
  /// baseline_stddev: as a share of the baseline.
  HeightMeasurement(const StereoRig& rig, const KalmanHeightParameters& parameters,
                    const RunwayParameters& runway = {}, double baseline_stddev = 0);

  /// by_ground: of the same pair. The result is without a failure where the width alone gives a height.
  MeasuredHeight propose(const PairInput& in, const Ground& ground, const MeasuredHeight& by_ground,
                         const HeightPrior& prior);
  /// After the track's verdict: learns the runway's width from a height that was accepted.
  void commit(const PairInput& in, const Ground& ground, const MeasuredHeight& measured, bool accepted);
  /// Of durations between stamps, over their squares.
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
