#pragma once

#include "results/disparity_sample.h"
#include "rig/rig_rotation.h"
#include "stereo/matching/shift_model.h"
#include "stereo/photometric/shift_matching.h"

namespace uav_landing {

/// Disparity from one block that shows more than noise, or from several together.
struct BlockDisparity {
  DisparitySample sample;   ///< pixels
  Eigen::RowVector3d leak;  ///< derivative of the disparity by the rows' rotation, pixels per rad
  int blocks;               ///< number of blocks in it
  bool alike;               ///< whether the right image shows them; else the disparity means nothing
};

/// Disparity that follows from a shift between the left image and the right one, which is warped by the
/// model. w: rotation that the vertical disparities of the images have, rad.
BlockDisparity disparityOf(const ShiftMatch& match, const StereoRig& rig, const ShiftModel& model,
                           const Eigen::Vector3d& w);

}  // namespace uav_landing
