#include "simulator/ground/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/ground/ground_texture.h"

namespace uav_landing {
namespace {

/// Spectrum of the clouds: amplitudes fall with spatial frequency f as f^-slope.
constexpr double kCloudSlope = 1.5;

}  // namespace

Scene::Scene(const SimulatedRunwayParameters& runway, const SimulatedSurfaceParameters& surface,
             uint64_t seed, Scenery scenery)
    : runway_(runway),
      surface_(surface),
      tyre_marks_(runway.tyre_marks),
      touchdown_(runway.aiming_point_distance + 0.5 * runway.aiming_point_length),
      touchdown_length_(std::max(0.6 * touchdown_, runway.width)),
      tyre_half_width_(0.2 * runway.width),
      runway_tile_(seed * 4 + 0, kGroundSlope),
      grass_tile_(seed * 4 + 1, kGroundSlope),
      cloud_tile_(seed * 4 + 2, kCloudSlope),
      scenery_(std::move(scenery)) {}

float Scene::tyreMarks(const GroundPatch& patch) const {
  const float x = std::min(patch.x, runway_.length() - patch.x) - touchdown_;
  const float along = x / touchdown_length_, across = patch.y / tyre_half_width_;
  const float density = tyre_marks_ * std::exp(-along * along - across * across);
  if (density < 0.004f) return 0;
  constexpr float kStreakLength = 8.0f, kStreakWidth = 0.12f;  // metres per texel
  const float streaks = runway_tile_.mean(patch.x / kStreakLength, patch.y / kStreakWidth + kTileShift,
                                          patch.length / kStreakLength, patch.width / kStreakWidth);
  return density * std::clamp(0.6f + 0.5f * streaks, 0.0f, 1.0f);
}

float Scene::ground(const GroundFootprint& footprint, const RunwaySurface::Cover& cover,
                    float distance) const {
  const GroundPatch& patch = footprint.box;
  float grey = 0;
  if (cover.runway > 0) {
    // Paint fills the surface's pores, so only half of the texture remains.
    const float texture = static_cast<float>(surface_.runway_contrast) *
                          groundTexture(runway_tile_, patch, surface_.runway_grain);
    const float bare = static_cast<float>(surface_.runway_brightness) * std::max(1.0f + texture, 0.0f);
    const float paint =
        static_cast<float>(surface_.marking_brightness) * std::max(1.0f + 0.5f * texture, 0.0f);
    grey += ((cover.runway - cover.paint) * bare + cover.paint * paint) * (1.0f - tyreMarks(patch));
  }
  if (cover.runway < 1) {
    const Scenery::Shown scenery = scenery_.shown(footprint);
    grey += (1.0f - cover.runway) * scenery.grey;
    if (scenery.bare > 0) {
      const float texture = static_cast<float>(surface_.grass_contrast) *
                            groundTexture(grass_tile_, patch, surface_.grass_grain);
      grey += (1.0f - cover.runway) * scenery.bare * static_cast<float>(surface_.grass_brightness) *
              std::max(1.0f + texture, 0.0f);
    }
  }
  const float haze = 1.0f - std::exp(-distance / static_cast<float>(surface_.visibility));
  return grey + haze * (static_cast<float>(surface_.sky_horizon) - grey);
}

float Scene::sky(const Eigen::Vector3f& direction, float extent) const {
  // The sky is a layer of clouds above the camera: a cloud at the elevation e is 1 / tan(e) away. The small
  // constant keeps the horizon at a finite distance, as the curved Earth does.
  const float up = std::max(direction.z(), 0.0f);
  const float range = 1.0f / (up + 0.08f);
  constexpr float kTexels = 40.0f;
  const float clouds = cloud_tile_.mean(direction.x() * range * kTexels, direction.y() * range * kTexels,
                                        extent * range * range * kTexels, extent * range * kTexels);
  const float horizon = surface_.sky_horizon, zenith = surface_.sky_zenith;
  return zenith + (horizon - zenith) * std::exp(-4.0f * up) +
         static_cast<float>(surface_.cloud_contrast) * clouds * std::min(1.0f, 8.0f * up + 0.1f);
}

}  // namespace uav_landing
