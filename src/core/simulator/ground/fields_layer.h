#pragma once

#include <cstdint>
#include <vector>

#include "simulator/ground/ground_layer.h"
#include "uav_landing/simulator/scenery_parameters.h"

namespace uav_landing {

/// A patchwork of fields. It consists of strips of random width, each divided into fields of random length.
/// Every field has its own grey level, and crop rows along one of its sides.
class FieldsLayer : public GroundLayer {
 public:
  FieldsLayer(const SimulatedFieldsParameters& fields, uint64_t seed);

  LayerCover cover(const GroundFootprint& footprint) const override;

 private:
  struct Field {
    float from, to;    ///< along the patchwork, m
    float brightness;  ///< mean grey level of the crop
    float rows;        ///< amplitude of the crop rows, as a share of the brightness
    bool rows_along;   ///< the rows follow the patchwork's direction
  };
  struct Strip {
    float from, to;  ///< across the patchwork, m
    std::vector<Field> fields;
  };
  /// Grey level in the middle of the patch, within the borders.
  float crop(const Field& field, const GroundPatch& patch) const;

  GroundFrame frame_;  ///< begins at the patchwork's corner
  float length_, width_;
  float contrast_, border_, border_brightness_, row_spacing_, mean_;
  std::vector<Strip> strips_;
};

}  // namespace uav_landing
