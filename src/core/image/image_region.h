#pragma once

namespace uav_landing {

/// Parts of the image's ground that one fault may spoil: dirt on a lens, a puddle, a slope, another surface.
/// Three strips by distance and two halves, with equally many points on the plane.
enum class ImageRegion { kNear, kMiddle, kFar, kLeft, kRight };
constexpr int kImageRegions = 5;

}  // namespace uav_landing
