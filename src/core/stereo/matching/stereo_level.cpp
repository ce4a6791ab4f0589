#include "stereo/matching/stereo_level.h"

#include <opencv2/imgproc.hpp>
#include <utility>

#include "image/input/image_check.h"
#include "image/windows/match_image.h"

namespace uav_landing {

StereoLevel reduceLevel(const RigModel& model, int factor, int margin) {
  StereoLevel level;
  level.rig = model.rig;
  level.rig.size = model.rig.size / factor;
  level.rig.fx /= factor;
  level.rig.fy /= factor;
  level.rig.cx = toCoarse(model.rig.cx, factor);
  level.rig.cy = toCoarse(model.rig.cy, factor);
  level.rig.cx_right = toCoarse(model.rig.cx_right, factor);
  const auto reduce = [&](const cv::Mat& mask) {
    // Pixels that do not fill a whole reduced pixel, on the right and below, are dropped.
    const cv::Size size = mask.size() / factor;
    cv::Mat reduced;
    cv::resize(mask(cv::Rect(cv::Point(), size * factor)), reduced, size, 0, 0, cv::INTER_AREA);
    cv::threshold(reduced, reduced, 254, 255, cv::THRESH_BINARY);
    return erodeMask(reduced, margin);
  };
  level.left_mask = reduce(model.left_mask);
  level.right_mask = reduce(model.right_mask);
  return level;
}

StereoLevel swapped(const StereoLevel& level) {
  StereoLevel other = level;
  std::swap(other.left, other.right);
  std::swap(other.left_mask, other.right_mask);
  std::swap(other.rig.cx, other.rig.cx_right);
  return other;
}

StereoLevel turnedOver(const StereoLevel& level) {
  constexpr int kBothAxes = -1;
  StereoLevel other = swapped(level);
  // cv::flip() does not work in place, and both levels share these images.
  for (cv::Mat* image : {&other.left, &other.right, &other.left_mask, &other.right_mask}) {
    cv::Mat turned;
    cv::flip(*image, turned, kBothAxes);
    *image = turned;
  }
  other.rig.cx = level.rig.size.width - 1 - other.rig.cx;
  other.rig.cx_right = level.rig.size.width - 1 - other.rig.cx_right;
  other.rig.cy = level.rig.size.height - 1 - other.rig.cy;
  return other;
}

}  // namespace uav_landing
