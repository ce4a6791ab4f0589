#pragma once

#include <optional>

#include "geometry/ground_normal.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/attitude_prior.h"

namespace uav_landing {

/// Sources of the ground normal. Each may be missing.
struct NormalSources {
  const GroundPlane* plane = nullptr;        ///< from stereo
  std::optional<GroundDirection> vanishing;  ///< vanishing direction of the runway
  std::optional<GroundNormal>
      level_rig;  ///< from the vanishing point alone, for a rig whose roll is hardly known
  const AttitudePrior& imu;
};
struct AngleNormal {
  GroundNormal normal;
  Failure imu_failure;  ///< set when the imu contradicts the other sources and was rejected
};
/// Ground normal that approach angles refer to. By default it is fused from all sources; normal_source can
/// ask for the paper's form instead. Returns nothing when there is no source.
std::optional<AngleNormal> findAngleNormal(const NormalSources& sources,
                                           const ApproachAngleParameters& parameters);

}  // namespace uav_landing
