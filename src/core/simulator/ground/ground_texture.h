#pragma once

#include "simulator/ground/ground_footprint.h"
#include "simulator/ground/noise_tile.h"

namespace uav_landing {

/// Shift in texels that keeps seams of the tiles away from the runway's centre line.
constexpr float kTileShift = 161.3f;
/// Spectrum of the ground's texture: amplitudes fall with the spatial frequency f as f^-slope.
constexpr double kGroundSlope = 0.8;

/// Texture of a surface at three scales, each with mean 0 and variance 1 before averaging. grain: smallest
/// detail, m.
float groundTexture(const NoiseTile& tile, const GroundPatch& patch, float grain);

}  // namespace uav_landing
