#include "uav_landing/image/rig_masks.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <system_error>
#include <utility>

#include "base/text.h"

namespace uav_landing {
namespace {

constexpr double kLeastShare = 0.1;  // share of the image that a mask has to leave

template <class... Parts>
Failure refusal(const RawMask& mask, const Parts&... parts) {
  return {Reason::kInputInvalid, text(mask.parameter, ": ", mask.file, ": ", parts...)};
}

std::string toText(cv::Size size) { return text(size.width, "x", size.height); }

/// Empty when the file contains no image. OpenCV throws when an image is too large for the memory.
cv::Mat readImage(const std::string& file) {
  try {
    return cv::imread(file, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};
  }
}

Failure checkType(const RawMask& mask) {
  if (mask.usable.type() == CV_8UC1) return {};
  return refusal(mask, "has ", mask.usable.channels(),
                 mask.usable.channels() == 1 ? " channel of " : " channels of ", 8 * mask.usable.elemSize1(),
                 " bit, expected one channel of 8 bit; convert it, for example: convert ", mask.file,
                 " -alpha off -colorspace Gray -depth 8 mask.png");
}

Failure checkShare(const RawMask& mask) {
  const double share = cv::countNonZero(mask.usable) / static_cast<double>(mask.usable.total());
  if (share >= kLeastShare) return {};
  return refusal(
      mask, "leaves ", rounded(100 * share), " % of the image, expected at least ", 100 * kLeastShare,
      " %: pixels that are not 0 (white) are used, those that are 0 (black) are left out; is it inverted?");
}

Failure read(RawMask& mask) {
  if (mask.file.empty()) return {};
  std::error_code none;
  if (!std::filesystem::exists(mask.file, none))
    return refusal(mask, "no such file; a relative path begins at the config file's folder");
  mask.usable = readImage(mask.file);
  if (mask.usable.empty()) return refusal(mask, "is not an image that can be read, expected a PNG");
  const Failure failure = checkType(mask);
  return failure ? failure : checkShare(mask);
}

}  // namespace

Expected<RigMasks> loadRigMasks(const RigParameters& parameters) {
  RigMasks masks{{{}, "rig/left_mask", parameters.left_mask}, {{}, "rig/right_mask", parameters.right_mask}};
  for (RawMask* mask : {&masks.left, &masks.right})
    if (const Failure failure = read(*mask)) return tl::make_unexpected(failure);
  if (parameters.upside_down) std::swap(masks.left, masks.right);
  return masks;
}

Failure checkMaskSize(const RawMask& mask, const CameraCalibration& calibration) {
  if (mask.usable.empty() || mask.usable.size() == calibration.imageSize()) return {};
  const bool of_full_picture = mask.usable.size() == cv::Size(calibration.width, calibration.height);
  return refusal(mask, "is ", toText(mask.usable.size()), ", expected ", toText(calibration.imageSize()),
                 ", the size of the raw images by camera_info",
                 of_full_picture ? ", whose ROI and binning count; cut and reduce the mask as the camera does"
                                 : "; draw it on a raw image of this camera");
}

}  // namespace uav_landing
