#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "simulator/ground/ground_layer.h"
#include "simulator/ground/noise_tile.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// The scenery around the runway. It is made of layers, the later ones over the earlier ones.
class Scenery {
 public:
  Scenery() = default;
  Scenery(const SimulatedSceneryParameters& scenery, const SimulatedRunwayParameters& runway,
          const SimulatedSurfaceParameters& surface, uint64_t seed);

  bool empty() const { return layers_.empty(); }
  /// True when a single sample of this ground is exact.
  bool even(const GroundFootprint& footprint) const;
  /// The scenery on a piece of ground, as the camera sees it.
  struct Shown {
    float grey = 0;  ///< light of all layers, in grey levels
    float bare = 1;  ///< share of the ground that no layer covers
  };
  Shown shown(const GroundFootprint& footprint) const;

 private:
  std::vector<std::shared_ptr<const GroundLayer>> layers_;  ///< the lowest one first
  std::shared_ptr<const NoiseTile> tile_;
  float grain_ = 1;
};

}  // namespace uav_landing
