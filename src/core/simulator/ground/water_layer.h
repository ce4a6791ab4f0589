#pragma once

#include "simulator/ground/ground_layer.h"
#include "uav_landing/simulator/scenery_parameters.h"

namespace uav_landing {

/// A river, a lake or the sea: water between two wavy banks, with sand along them. It has no ends.
class WaterLayer : public GroundLayer {
 public:
  explicit WaterLayer(const SimulatedWaterParameters& water);

  LayerCover cover(const GroundFootprint& footprint) const override;

 private:
  /// How far the near bank lies to the left of its straight line, and the derivative of that along the line.
  struct Bank {
    float across, slope;
  };
  Bank bank(float along) const;

  GroundFrame frame_;
  float width_, wave_, wave_length_;
  float brightness_, contrast_, beach_, beach_brightness_;
};

}  // namespace uav_landing
