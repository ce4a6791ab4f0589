#pragma once

#include <Eigen/Core>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// What one raw pixel sees, in the axes of the rectified left camera: direction (x, y, 1) of its centre, and
/// how the direction changes from one pixel to the next along the row (u) and the column (v).
struct PixelRay {
  float x, y;
  float xu, yu;
  float xv, yv;
};

/// One camera of the simulated rig.
struct SimulatedCamera {
  CameraCalibration calibration;  ///< what camera_info says
  double offset_x = 0;            ///< true centre to the right of the left camera's, m; rectified axes
  std::vector<PixelRay> rays;     ///< true ones, row by row
};

/// The two cameras with lenses, and the rectification of the pair (Bouguet's, by cv::stereoRectify) that
/// gives R and P. Both rectified cameras have the same axes and the right one is offset_x along their x, but
/// for the calibration error: the real right camera's.
struct CameraRig {
  SimulatedCamera left, right;
};

/// The rig of these parameters, or why there cannot be one: a lens that folds back within the image.
Expected<CameraRig> makeCameraRig(const SimulatorParameters& parameters);

}  // namespace uav_landing
