#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

struct CameraPair {
  CameraCalibration left, right;
};

/// The cameras that the stages work with, from those that camera_info describes. They are the same except in
/// two cases. Then only R and P change, so raw images, their masks, K, D and tf stay as they are.
///
/// First, the baseline may be slightly slanted in the axes of P (0.3 deg in the colour images of KITTI). Both
/// rectified cameras are turned by this angle, which makes their rows level.
///
/// Second, with upside_down both rectified cameras are turned by 180 deg about their optical axes, and left
/// and right are exchanged. The rectified images are then those of an upright pair. The caller has to
/// exchange images, stamps and frame_ids as well.
///
/// The failure is that of makeStereoRig(), with left and right as given.
Expected<CameraPair> workingPair(const CameraCalibration& left, const CameraCalibration& right,
                                 const RigParameters& parameters);

}  // namespace uav_landing
