#pragma once

#include "height/camera_twist.h"
#include "integrity/memory/ground_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "landing/watch/pair_monitor.h"
#include "landing/watch/path_doubt.h"

namespace uav_landing {

// These functions carry the results of the parts into the published result. Each fills its own fields.

/// Sets the failure unless there is one already: the first reason counts, as later ones follow from it.
void addFailure(LandingResult& result, const Failure& failure);
/// Makes the height invalid if there is a failure.
void refuseHeight(LandingResult& result, const Failure& failure);

/// Reports the heights of the pair and of the track, the status and the counts.
void reportHeight(const MeasuredHeight& measured, const PairVerdict& pair, const TrackVerdict& post,
                  LandingResult& result);

/// Reports the protection level and its source. The height becomes invalid when the level exceeds the alert
/// limit. below: see SurfaceBelow.
void reportProtection(const HeightTrack& track, const std::optional<GroundMemory::Below>& below,
                      const KalmanHeightParameters& parameters, LandingResult& result);

/// Reports the approach angles with their variances.
void reportAngle(const PairInput& in, const Ground& ground, const PathDoubt& doubt,
                 const VelocityWatch::Verdict& velocity, LandingResult& result);
/// Decides whether the angle is valid. refusal: other reason against it, if any.
void judgeAngle(const PairInput& in, const Failure& refusal, double max_stddev_deg, LandingResult& result);

/// Reason against an angle besides its own uncertainty; the first one counts. otherwise: returned when no
/// test of the pair refuses the angle.
Failure refusalOf(const MeasuredHeight& measured, const PairVerdict& pair, const Failure& otherwise);

/// What makes metres of a step, whose lengths are in heights.
struct StepScale {
  double height, variance;  ///< above the plane ahead, m, m^2
  double length_change;     ///< by the normal that the height refers to, as a share
};
/// result: with the published height.
StepScale scaleOfStep(const StereoRig& rig, const PairInput& in, const Ground& ground,
                      const LandingResult& result);
/// Velocity and rate of turn from the step since the previous pair. The covariance contains errors that the
/// step itself does not show.
CameraTwist believedTwist(const PairInput& in, const PairVerdict& pair, const StepScale& scale,
                          const MotionDoubt& doubt);

void reportTwist(const CameraTwist& twist, LandingResult& result);

/// Reports the rig's rotation. If it is certainly too large, height, angle and position become invalid.
void reportRig(const RigRotation& rotation, double max_rotation_deg, LandingResult& result);

}  // namespace uav_landing
