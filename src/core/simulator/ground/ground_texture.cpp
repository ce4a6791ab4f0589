#include "simulator/ground/ground_texture.h"

#include <algorithm>

namespace uav_landing {
namespace {

/// Ratio of the texture's scales. It is no small ratio of whole numbers, so the repeats of two scales never
/// coincide.
constexpr float kScaleRatio = 19.7f;

}  // namespace

float groundTexture(const NoiseTile& tile, const GroundPatch& patch, float grain) {
  float sum = 0;
  float texels_per_metre = 1.0f / grain;
  for (int scale = 0; scale < 3; ++scale, texels_per_metre /= kScaleRatio) {
    const float length = patch.length * texels_per_metre, width = patch.width * texels_per_metre;
    // A patch as large as the whole tile must not show its repeats.
    constexpr float kWhole = NoiseTile::kSize, kNone = kWhole / 4;
    const float fade = (kWhole - std::max(length, width)) / (kWhole - kNone);
    if (fade <= 0) continue;
    sum += std::min(fade, 1.0f) * tile.mean(patch.x * texels_per_metre + kTileShift,
                                            patch.y * texels_per_metre + kTileShift, length, width);
  }
  return sum;
}

}  // namespace uav_landing
