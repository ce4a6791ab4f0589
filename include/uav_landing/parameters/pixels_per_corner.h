#pragma once

namespace uav_landing {

/// Default number of image pixels for each corner. Where half of the image is ground, windows of the usual
/// radius then hardly overlap, even with the margin that smoothing adds.
constexpr int kUsualPixelsPerCorner = 300;

}  // namespace uav_landing
