#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/row_times.h"
#include "uav_landing/image/rig_masks.h"

namespace uav_landing {

class Resampler;

/// The paper's pre-process: turns a raw image into the rectified one by precomputed fixed-point maps. It uses
/// R and P even when D is zero. It also uses binning and ROI of the camera_info.
class Rectifier {
 public:
  /// Makes maps and mask for one camera. Fails when its calibration is wrong.
  static Expected<Rectifier> create(const CameraCalibration& calibration);

  /// raw: mono8 of calibration.imageSize(). out: mono8 of the same size; its memory is reused. Where the raw
  /// image has no pixels, out is 0 (see mask()).
  Failure rectify(const cv::Mat& raw, cv::Mat& out) const;

  /// 255 where the rectified image has all its source pixels, else 0; mono8, in the size of the image.
  const cv::Mat& mask() const { return mask_; }
  const CameraCalibration& calibration() const { return calibration_; }

 private:
  CameraCalibration calibration_;
  cv::Mat mask_;
  std::shared_ptr<const Resampler> resampler_;  // none when images only have to be copied
};

/// Describes the cameras for the stages after rectification: the rig, the usable pixels of the rectified
/// images, and when they are exposed. A pixel is usable (mono8, 255) if all its source pixels lie in the raw
/// image and in its mask. Only makeRigModel() derives all this from the two camera_infos.
struct RigModel {
  StereoRig rig;
  cv::Mat left_mask, right_mask;
  RowTimes left_times = {}, right_times = {};
  /// Times of the left image at a readout of 1 s, if no readout time is given. Else a global shutter.
  RowTimes left_unit_times = {};
  bool estimates_readout = false;  ///< whether the readout time has to be estimated
};
/// Refuses masks of another size than the raw images. parameters: used for the readout.
Expected<RigModel> makeRigModel(const CameraCalibration& left, const CameraCalibration& right,
                                const RigMasks& masks = {}, const RigParameters& parameters = {});

}  // namespace uav_landing
