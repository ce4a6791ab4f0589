#pragma once

#include <cstdint>
#include <vector>

#include "simulator/ground/ground_layer.h"
#include "uav_landing/simulator/scenery_parameters.h"

namespace uav_landing {

/// A grid of streets with blocks between them. A block is divided into plots. On most plots there is a roof:
/// two halves of different grey levels with the ridge between them.
class TownLayer : public GroundLayer {
 public:
  TownLayer(const SimulatedTownParameters& town, uint64_t seed);

  LayerCover cover(const GroundFootprint& footprint) const override;

 private:
  /// The pattern along one axis of the town: a street, a block of plots, a street, and so on.
  struct Grid {
    float street, period, plot;
    int plots;  ///< number in a block
    int count;  ///< number in the town
    Grid(double street, double block, double plot, double whole);
    float plotFrom(int index) const;
    int plotAt(float s) const;
    /// Share of streets in an interval.
    float streets(float from, float to) const;
  };
  struct Rectangle {
    float x, y, length, width;  ///< middle and sides, m
    float brightness;
  };
  struct Roof {
    bool built;
    Rectangle halves[2];
  };
  /// Share and light of the roofs that lie on a patch.
  struct Roofs {
    float share = 0, light = 0;
    bool one = false;
  };
  Roofs roofs(const GroundPatch& patch) const;

  GroundFrame frame_;  ///< begins at the town's corner
  float length_, width_;
  Grid along_, across_;
  float street_brightness_, garden_brightness_, contrast_;
  float mean_roofs_ = 0,
        mean_light_ = 0;     ///< mean over the blocks' area: share of roofs, and their grey level times it
  std::vector<Roof> roofs_;  ///< [index along * plots across + index across]
};

}  // namespace uav_landing
