#pragma once

#include "simulator/ground/ground_footprint.h"

namespace uav_landing {

/// What a layer puts on a piece of ground.
struct LayerCover {
  float share = 0;     ///< of the ground that it covers
  float grey = 0;      ///< mean grey level of what it covers, without texture
  float contrast = 0;  ///< 1 sigma of each scale of its texture, share of the grey level
  /// It shows one material alone, or nothing: a single sample of this ground is exact.
  bool even = true;
};

/// One element of the scenery: something flat that covers a part of the ground.
class GroundLayer {
 public:
  virtual ~GroundLayer() = default;
  virtual LayerCover cover(const GroundFootprint& footprint) const = 0;
};

}  // namespace uav_landing
