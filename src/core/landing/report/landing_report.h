#pragma once

#include "height/camera_twist.h"
#include "integrity/ground_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"
#include "landing/watch/pair_monitor.h"
#include "landing/watch/path_doubt.h"

namespace uav_landing {

// From the values of the parts to the result that is published. Each fills its own fields.

/// The first reason counts: later ones follow from it.
void addFailure(LandingResult& result, const Failure& failure);
/// The height is not valid for this reason, if there is one.
void refuseHeight(LandingResult& result, const Failure& failure);

/// Heights of the pair and of the track, status and counts.
void reportHeight(const MeasuredHeight& measured, const PairVerdict& pair, const TrackVerdict& post,
                  LandingResult& result);

/// Protection level with its source, and whether the height is not valid for it. below: see SurfaceBelow.
void reportProtection(const HeightTrack& track, const std::optional<GroundMemory::Below>& below,
                      const KalmanHeightParameters& parameters, LandingResult& result);

/// Approach angles with their variances.
void reportAngle(const PairInput& in, const Ground& ground, const PathDoubt& doubt,
                 const VelocityWatch::Verdict& velocity, LandingResult& result);
/// Whether the angle is valid. refusal: what else speaks against it, if anything.
void judgeAngle(const PairInput& in, const Failure& refusal, double max_stddev_deg, LandingResult& result);

/// What else than its own uncertainty speaks against an angle, the first reason first. otherwise: where no
/// test of the pair refuses it.
Failure refusalOf(const MeasuredHeight& measured, const PairVerdict& pair, const Failure& otherwise);

/// Velocity and turn by the step since the pair before, with what the step itself does not know of them.
CameraTwist believedTwist(const StereoRig& rig, const PairInput& in, const Ground& ground,
                          const PairVerdict& pair, const LandingResult& result, const MotionDoubt& doubt);

void reportTwist(const CameraTwist& twist, LandingResult& result);

/// The rig's rotation. One that is certainly too large withdraws everything.
void reportRig(const RigRotation& rotation, double max_rotation_deg, LandingResult& result);

}  // namespace uav_landing
