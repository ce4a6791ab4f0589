#include "simulator/ground/scenery.h"

#include <algorithm>

#include "simulator/ground/fields_layer.h"
#include "simulator/ground/ground_texture.h"
#include "simulator/ground/paved_layer.h"
#include "simulator/ground/town_layer.h"
#include "simulator/ground/water_layer.h"

namespace uav_landing {
namespace {

/// Mown grass around the runway.
class GrassStripLayer : public GroundLayer {
 public:
  GrassStripLayer(const SimulatedGrassStripParameters& strip, const SimulatedRunwayParameters& runway,
                  const SimulatedSurfaceParameters& surface)
      : from_(-runway.displaced_threshold - strip.end),
        to_(runway.length + runway.displaced_threshold + strip.end),
        half_width_(0.5 * runway.width + strip.side),
        brightness_(surface.grass_brightness),
        contrast_(surface.grass_contrast) {}

  LayerCover cover(const GroundFootprint& footprint) const override {
    const GroundPatch& patch = footprint.box;
    const float share =
        overlap(patch.x, patch.length, from_, to_) * overlap(patch.y, patch.width, -half_width_, half_width_);
    return {share, brightness_, contrast_, share == 0 || share == 1};
  }

 private:
  float from_, to_, half_width_, brightness_, contrast_;
};

template <class Element>
bool isThere(const Element& element) {
  return element.length > 0 && element.width > 0;
}

}  // namespace

Scenery::Scenery(const SimulatedSceneryParameters& p, const SimulatedRunwayParameters& runway,
                 const SimulatedSurfaceParameters& surface, uint64_t seed)
    : grain_(surface.grass_grain) {
  const auto add = [this](auto layer) {
    layers_.push_back(std::make_shared<decltype(layer)>(std::move(layer)));
  };
  if (isThere(p.fields)) add(FieldsLayer(p.fields, seed));
  for (const SimulatedWaterParameters* water : {&p.river, &p.shore})
    if (water->width > 0) add(WaterLayer(*water));
  if (isThere(p.town)) add(TownLayer(p.town, seed));
  if (p.grass_strip.side > 0) add(GrassStripLayer(p.grass_strip, runway, surface));
  for (const SimulatedStripParameters* strip : {&p.road, &p.taxiway})
    if (isThere(*strip)) add(PavedLayer(*strip));
  if (isThere(p.crossing_runway)) add(PavedLayer(p.crossing_runway, runway, surface));
  if (!empty()) tile_ = std::make_shared<NoiseTile>(seed * 4 + 3, kGroundSlope);
}

bool Scenery::even(const GroundFootprint& footprint) const {
  // In any frame, the footprint's corners lie within a box that is larger by this factor.
  constexpr float kToCorners = 1.41422f;
  const GroundFootprint around = footprint.scaled(kToCorners);
  for (auto layer = layers_.rbegin(); layer != layers_.rend(); ++layer) {
    const LayerCover cover = (*layer)->cover(around);
    if (!cover.even) return false;
    if (cover.share == 1) return true;  // it hides the layers below
  }
  return true;
}

Scenery::Shown Scenery::shown(const GroundFootprint& footprint) const {
  Shown shown;
  float textured = 0;
  for (auto layer = layers_.rbegin(); layer != layers_.rend() && shown.bare > 0; ++layer) {
    const LayerCover cover = (*layer)->cover(footprint);
    const float light = shown.bare * cover.share * cover.grey;
    shown.grey += light;
    textured += light * cover.contrast;
    shown.bare *= 1 - cover.share;
  }
  if (textured > 0) shown.grey += textured * groundTexture(*tile_, footprint.box, grain_);
  shown.grey = std::max(shown.grey, 0.0f);
  return shown;
}

}  // namespace uav_landing
