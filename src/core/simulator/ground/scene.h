#pragma once

#include <Eigen/Core>

#include "simulator/ground/noise_tile.h"
#include "simulator/ground/runway_surface.h"
#include "simulator/ground/scenery.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Brightness of the ground and the sky in grey levels, averaged over the area of one sample. The ground is
/// the plane z = 0 of the runway frame.
class Scene {
 public:
  Scene(const SimulatedRunwayParameters& runway, const SimulatedSurfaceParameters& surface, uint64_t seed,
        Scenery scenery = {});

  RunwaySurface::Cover cover(const GroundFootprint& footprint) const { return runway_.cover(footprint.box); }
  /// True when a single sample of this ground is exact.
  bool even(const GroundFootprint& footprint, const RunwaySurface::Cover& cover) const {
    return cover.pure() && (cover.runway == 1.0f || scenery_.even(footprint));
  }
  /// Grey level of a piece of ground with this cover. distance: from the camera, m, for the haze.
  float ground(const GroundFootprint& footprint, const RunwaySurface::Cover& cover, float distance) const;

  /// Grey level of the sky in a unit direction of the runway frame. extent: angle that the sample covers,
  /// rad.
  float sky(const Eigen::Vector3f& direction, float extent) const;

 private:
  float tyreMarks(const GroundPatch& patch) const;

  RunwaySurface runway_;
  SimulatedSurfaceParameters surface_;
  float tyre_marks_, touchdown_, touchdown_length_, tyre_half_width_;
  NoiseTile runway_tile_, grass_tile_, cloud_tile_;
  Scenery scenery_;
};

}  // namespace uav_landing
