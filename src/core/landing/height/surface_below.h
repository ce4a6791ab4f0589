#pragma once

#include <optional>

#include "integrity/ground_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// The ground straight below, as it was when it was in view: carried along by the motion.
class SurfaceBelow {
 public:
  /// gate: sigmas.
  SurfaceBelow(const StereoRig& rig, double gate) : rig_(rig), gate_(gate) {}

  /// Carries on the ground that was in view, and adds that of this pair. left_out: by a test. post: of the
  /// pair.
  void follow(const PairInput& in, const Ground& ground, const MeasuredHeight& measured, bool left_out,
              const TrackVerdict& post);
  /// Of the ground: by this pair, else that of the pairs before, carried on.
  Eigen::Vector3d normal(const PairInput& in, const Ground& ground) const;
  /// The height above it, where the ground has this normal and the published height is this one, m.
  std::optional<GroundMemory::Below> below(double height, const Eigen::Vector3d& normal) const;

 private:
  struct Step;
  void carry(const PairInput& in, const Ground& ground, const Step& step);
  bool agreesWithFlight(const ApproachAngleResult::Motion& motion, const Step& step) const;

  StereoRig rig_;
  double gate_;  // sigmas
  GroundMemory memory_;
  std::optional<double> stamp_;                 // up to which the ground has been carried on, s
  double height_ = kUnknown;                    // at that time, m
  std::optional<Eigen::Vector3d> last_normal_;  // of the ground on the pair before
};

}  // namespace uav_landing
