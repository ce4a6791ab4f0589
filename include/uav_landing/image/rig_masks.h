#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "uav_landing/base/failure.h"
#include "uav_landing/geometry/calibration.h"
#include "uav_landing/parameters/rig_parameters.h"

namespace uav_landing {

/// The usable pixels of one camera's raw images, as a person has drawn them.
struct RawMask {
  cv::Mat usable;         ///< mono8, nonzero: usable; empty: all are
  std::string parameter;  ///< parameter that names the file, such as rig/left_mask
  std::string file;
};

struct RigMasks {
  RawMask left, right;
};

/// Reads the files that the parameters name. It refuses a file that does not exist, is no image, or does not
/// have one channel of 8 bits. It also refuses a mask that leaves less than a tenth of the image. The failure
/// names the parameter and the file. The masks are those of the working pair: see workingPair() for a rig
/// that is mounted upside down.
Expected<RigMasks> loadRigMasks(const RigParameters& parameters);

/// Refuses a mask whose size is not that of the images that the camera delivers, with ROI and binning.
Failure checkMaskSize(const RawMask& mask, const CameraCalibration& calibration);

}  // namespace uav_landing
