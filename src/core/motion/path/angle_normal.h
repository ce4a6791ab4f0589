#pragma once

#include <optional>

#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/parameters/approach_angle_parameters.h"
#include "uav_landing/results/attitude_prior.h"

namespace uav_landing {

/// What the ground's normal can be found from. Each may be missing.
struct NormalSources {
  const GroundPlane* plane = nullptr;  ///< by stereo
  GroundDirection vanishing;           ///< of the runway
  GroundNormal level_rig;              ///< by the vanishing point, of a rig whose roll is hardly known
  const AttitudePrior& imu;
};
struct AngleNormal {
  GroundNormal normal;
  Failure imu_failure;  ///< the imu contradicts the others and has been left out
};
/// The normal that approach angles refer to: of all sources, or as the paper has it (normal_source). None
/// without any.
std::optional<AngleNormal> findAngleNormal(const NormalSources& sources,
                                           const ApproachAngleParameters& parameters);

}  // namespace uav_landing
