#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

/// Which pixels of one camera's raw pictures may be used, as a person has drawn it.
struct RawMask {
  cv::Mat usable;         ///< mono8, nonzero: may be used; empty: all may
  std::string parameter;  ///< that names the file: rig/left_mask
  std::string file;
};

struct RigMasks {
  RawMask left, right;
};

/// Reads the files that the parameters name. Refuses one that is not there, is no image, has not one channel
/// of 8 bit, or leaves less than a tenth of the picture. The failure names the parameter and the file. The
/// masks are those of the working pair: see workingPair() for a rig that is mounted upside down.
Expected<RigMasks> loadRigMasks(const RigParameters& parameters);

/// Refuses a mask that is not as large as the pictures that the camera delivers, with ROI and binning.
Failure checkMaskSize(const RawMask& mask, const CameraCalibration& calibration);

}  // namespace uav_landing
