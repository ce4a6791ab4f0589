#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/image/rig_masks.h"

namespace uav_landing {

class Resampler;

/// The paper's pre-process: turns a raw image into the rectified one by precomputed fixed-point maps. It uses
/// R and P even when D is zero, and binning and ROI of the camera_info.
class Rectifier {
 public:
  /// Maps and mask for one camera. The failure is what is wrong with its calibration.
  static Expected<Rectifier> create(const CameraCalibration& calibration);

  /// raw: mono8 of calibration.imageSize(). out: mono8 of the same size; its memory is reused. Where the raw
  /// image has no pixels, out is 0 (see mask()).
  Failure rectify(const cv::Mat& raw, cv::Mat& out) const;

  /// 255 where the rectified image has all its source pixels, else 0; mono8, size of the image.
  const cv::Mat& mask() const { return mask_; }
  const CameraCalibration& calibration() const { return calibration_; }

 private:
  CameraCalibration calibration_;
  cv::Mat mask_;
  std::shared_ptr<const Resampler> resampler_;  // none when images only have to be copied
};

/// What the stages behind rectification know of the cameras: the rig, the usable pixels of the rectified
/// images, and when they are exposed. Usable (mono8, 255) are pixels whose source pixels all lie in the raw
/// image and in its mask. Only makeRigModel() derives all this from the two camera_infos.
struct RigModel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;
  RowTimes left_times = {}, right_times = {};
  /// Where no readout time is given: the left image as a readout of 1 s has it. Else a global shutter.
  RowTimes left_unit_times = {};
};
/// Refuses masks of another size than the raw images. parameters: for the readout.
Expected<RigModel> makeRigModel(const CameraCalibration& left, const CameraCalibration& right,
                                const RigMasks& masks = {}, const RigParameters& parameters = {});

}  // namespace uav_landing
