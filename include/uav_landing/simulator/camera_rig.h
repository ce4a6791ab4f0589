#pragma once

#include <Eigen/Core>
#include <vector>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// The ray of one raw pixel, in the axes of the rectified left camera. (x, y, 1) is the direction of its
/// centre. The other numbers are the change of this direction to the next pixel along the row (u) and along
/// the column (v).
struct PixelRay {
  float x, y;
  float xu, yu;
  float xv, yv;
};

/// One camera of the simulated rig.
struct SimulatedCamera {
  CameraCalibration calibration;  ///< content of camera_info
  double offset_x = 0;            ///< true centre, to the right of the left camera's, m; rectified axes
  std::vector<PixelRay> rays;     ///< true rays, row by row
};

/// The two cameras with lenses, and the rectification of the pair (Bouguet's method, by cv::stereoRectify),
/// which gives R and P. Both rectified cameras have the same axes, and the right one is offset_x along their
/// x. Only the real right camera differs from that, by the calibration error.
struct CameraRig {
  SimulatedCamera left, right;
};

/// Makes the rig of these parameters. It fails when a lens folds back within the image.
Expected<CameraRig> makeCameraRig(const SimulatorParameters& parameters);

}  // namespace uav_landing
