#pragma once

namespace uav_landing {

/// Pixels of the image for each corner, by default: windows of the usual radius, with what smoothing adds to
/// them, then hardly overlap where half of the image is ground.
constexpr int kUsualPixelsPerCorner = 300;

}  // namespace uav_landing
