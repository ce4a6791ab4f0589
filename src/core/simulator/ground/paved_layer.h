#pragma once

#include "simulator/ground/ground_layer.h"
#include "simulator/ground/runway_surface.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// A strip that is made like a runway, anywhere and in any direction: a road, a taxiway, or another runway.
class PavedLayer : public GroundLayer {
 public:
  /// A road or a taxiway.
  explicit PavedLayer(const SimulatedStripParameters& strip);
  /// A runway with those marks of the main one for which there is room.
  PavedLayer(const SimulatedCrossingParameters& crossing, const SimulatedRunwayParameters& main,
             const SimulatedSurfaceParameters& surface);

  LayerCover cover(const GroundFootprint& footprint) const override;

 private:
  GroundFrame frame_;  ///< begins in the middle of the strip's end
  RunwaySurface surface_;
  float brightness_, line_brightness_, contrast_;
};

}  // namespace uav_landing
