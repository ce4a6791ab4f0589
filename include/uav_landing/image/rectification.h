#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/image/rig_masks.h"

namespace uav_landing {

class Resampler;

/// The paper's pre-process: turns a raw image into the rectified one by precomputed fixed-point maps.
/// Honours R and P even when D is zero, and binning and ROI of the camera_info.
class Rectifier {
 public:
  /// Maps and mask for one camera, or what is wrong with its calibration.
  static Expected<Rectifier> create(const CameraCalibration& calibration);

  /// raw: mono8 of calibration.imageSize(). out: mono8 of the same size, memory is reused.
  /// Where the raw image has nothing to give, out is 0 (see mask()).
  Failure rectify(const cv::Mat& raw, cv::Mat& out) const;

  /// 255 where the rectified image has all its source pixels, 0 elsewhere; mono8, size of the image.
  const cv::Mat& mask() const { return mask_; }
  const CameraCalibration& calibration() const { return calibration_; }

 private:
  CameraCalibration calibration_;
  cv::Mat mask_;
  std::shared_ptr<const Resampler> resampler_;  // none where there is nothing to do but copy
};

/// What the stages behind rectification know of the cameras: the rig, which pixels of the rectified images
/// may be used (mono8, 255 where they may): those all of whose source pixels are in the raw image, and in
/// what its mask leaves, and when they are exposed. The one place that derives all from the two camera_infos.
struct RigModel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;
  RowTimes left_times = {}, right_times = {};
  /// Where no readout time is given: the left image as a readout of 1 s has it. Else a global shutter.
  RowTimes left_unit_times = {};
};
/// Refuses masks of another size than the raw images. parameters: of the readout.
Expected<RigModel> makeRigModel(const CameraCalibration& left, const CameraCalibration& right,
                                const RigMasks& masks = {}, const RigParameters& parameters = {});

}  // namespace uav_landing
