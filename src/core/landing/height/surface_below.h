#pragma once

#include <optional>

#include "integrity/memory/ground_memory.h"
#include "landing/height/ground_estimate.h"
#include "landing/height/height_track.h"
#include "landing/height/measured_height.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// Remembers the ground while it is in view, and carries it along with the motion until it is straight below.
class SurfaceBelow {
 public:
  /// gate: in standard deviations.
  SurfaceBelow(const StereoRig& rig, double gate) : rig_(rig), gate_(gate) {}

  /// Carries on the remembered ground and adds the ground of this pair. left_out: a test rejected the pair.
  /// post: track after this pair.
  void follow(const PairInput& in, const Ground& ground, const MeasuredHeight& measured, bool left_out,
              const TrackVerdict& post);
  /// Ground normal of this pair, or that of the previous pairs carried on. Nothing before the first one.
  std::optional<Eigen::Vector3d> normal(const PairInput& in, const Ground& ground) const;
  /// Height above the remembered ground straight below, m. height: published. normal: of the ground.
  std::optional<GroundMemory::Below> below(double height, const Eigen::Vector3d& normal) const;

 private:
  struct Step;
  void carry(const PairInput& in, const Ground& ground, const Step& step);
  bool agreesWithFlight(const ApproachAngleResult::Motion& motion, const Step& step) const;

  StereoRig rig_;
  double gate_;  // standard deviations
  GroundMemory memory_;
  std::optional<double> stamp_;                 // time to which the ground has been carried on, s
  double height_ = kUnknown;                    // at that time, m
  std::optional<Eigen::Vector3d> last_normal_;  // ground normal of the previous pair
};

}  // namespace uav_landing
