#pragma once

namespace uav_landing {

/// Distance that the camera moved since the pair before, in any direction.
struct CameraStep {
  double duration = 0;           ///< s
  double way = 0, variance = 0;  ///< m, m^2
};

}  // namespace uav_landing
