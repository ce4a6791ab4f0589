#pragma once

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

struct CameraPair {
  CameraCalibration left, right;
};

/// The cameras that the stages work with, of those that camera_info describes. They are the same but for two
/// cases. Only R and P change then, so raw pictures, their masks, K, D and tf stay as they are.
///
/// A baseline that is a little aslant in the axes of P (as in the colour pictures of KITTI: 0.3 deg): both
/// rectified cameras are turned by that angle, which makes their rows level.
///
/// upside_down: both rectified cameras are turned by 180 deg about their optical axes, and the right camera
/// is the left one from then on. The rectified pictures are those of a pair that stands upright. Images,
/// stamps and frame_ids have to be exchanged by the caller, too.
///
/// The failure is that of makeStereoRig(), and its left and right are the given ones.
Expected<CameraPair> workingPair(const CameraCalibration& left, const CameraCalibration& right,
                                 const RigParameters& parameters);

}  // namespace uav_landing
