#pragma once

namespace uav_landing {

/// Regions of the ground in the image that one fault may spoil: dirt on a lens, a puddle, a slope, another
/// surface. There are three strips by distance and two halves, each with the same number of points on the
/// plane.
enum class ImageRegion { kNear, kMiddle, kFar, kLeft, kRight };
constexpr int kImageRegions = 5;

}  // namespace uav_landing
