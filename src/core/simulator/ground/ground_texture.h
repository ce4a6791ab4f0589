#pragma once

#include "simulator/ground/ground_footprint.h"
#include "simulator/ground/noise_tile.h"

namespace uav_landing {

/// Keeps seams of the tiles away from the runway's centre line, texels.
constexpr float kTileShift = 161.3f;
/// Spectrum of a ground's texture: amplitudes fall with spatial frequency f as f^-slope.
constexpr double kGroundSlope = 0.8;

/// A surface's texture at three scales, mean 0, each with variance 1 before averaging. grain: smallest
/// detail, m.
float groundTexture(const NoiseTile& tile, const GroundPatch& patch, float grain);

}  // namespace uav_landing
