#pragma once

#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace test {

/// The simulator's defaults with pictures of this size, px, and this focal length, principal points in the
/// middle.
inline SimulatorParameters smallPictures(int width, int height, double f) {
  SimulatorParameters p;
  p.image.width = width;
  p.image.height = height;
  for (SimulatedCameraParameters* camera : {&p.left_camera, &p.right_camera}) {
    camera->fx = camera->fy = f;
    camera->cx = 0.5 * (width - 1);
    camera->cy = 0.5 * (height - 1);
  }
  return p;
}

}  // namespace test
}  // namespace uav_landing
