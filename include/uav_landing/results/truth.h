#pragma once

#include <Eigen/Core>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// True values of one frame, of the rectified left camera; kUnknown (NaN) when not known. The approach angle,
/// the focus of expansion and the speed belong to the step from the previous frame.
struct Truth {
  double height = kUnknown;          ///< above the surface below the camera, m
  double approach_angle = kUnknown;  ///< of the chord from the previous position, positive descending, rad
  Eigen::Vector2d foe = Eigen::Vector2d::Constant(kUnknown);  ///< pixels of the current rectified left image
  double speed = kUnknown;  ///< length of the chord over the time between the frames, m/s
  double pitch = kUnknown;  ///< optical axis above the surface, rad; looking down is negative
  double roll = kUnknown;   ///< right side down is positive, rad
  double yaw = kUnknown;    ///< optical axis left of the landing direction, rad
  double x = kUnknown;      ///< along the landing direction from the threshold, m
  double y = kUnknown;      ///< left of the centre line, m
};

}  // namespace uav_landing
