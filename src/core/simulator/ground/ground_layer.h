#pragma once

#include "simulator/ground/ground_footprint.h"

namespace uav_landing {

/// The part of a piece of ground that a layer covers, and its look.
struct LayerCover {
  float share = 0;     ///< share of the ground that the layer covers
  float grey = 0;      ///< mean grey level of what it covers, without texture
  float contrast = 0;  ///< 1 sigma of each scale of its texture, as a share of the grey level
  /// True when it shows only one material, or nothing. A single sample of this ground is then exact.
  bool even = true;
};

/// One element of the scenery: a flat object that covers a part of the ground.
class GroundLayer {
 public:
  virtual ~GroundLayer() = default;
  virtual LayerCover cover(const GroundFootprint& footprint) const = 0;
};

}  // namespace uav_landing
