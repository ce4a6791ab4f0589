#pragma once

#include "results/disparity_sample.h"
#include "rig/rig_rotation.h"
#include "stereo/matching/shift_model.h"
#include "stereo/photometric/shift_matching.h"

namespace uav_landing {

/// What one block that shows more than noise, or several together, say of the disparity.
struct BlockDisparity {
  DisparitySample sample;   ///< pixels
  Eigen::RowVector3d leak;  ///< the disparity's derivative by the rows' rotation, pixels per rad
  int blocks;               ///< that say so
  bool alike;               ///< whether the right image shows them: of others the disparity means nothing
};

/// Of a shift between the left image and the right one that is warped by the model. w: rotation that the
/// vertical disparities of the images have, rad.
BlockDisparity disparityOf(const ShiftMatch& match, const StereoRig& rig, const ShiftModel& model,
                           const Eigen::Vector3d& w);

}  // namespace uav_landing
