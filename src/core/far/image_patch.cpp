#include "far/image_patch.h"

#include <opencv2/imgproc.hpp>

namespace uav_landing {

void ImagePatch::take(const cv::Mat& image, const cv::Rect& place) {
  place_ = place & cv::Rect(0, 0, image.cols, image.rows);
  grey_ = place_.area() > 0 ? image(place_).clone() : cv::Mat();
}

cv::Point ImagePatch::movement(const cv::Mat& image, int reach) const {
  const cv::Rect around(place_.x - reach, place_.y - reach, place_.width + 2 * reach,
                        place_.height + 2 * reach);
  const cv::Rect inside = around & cv::Rect(0, 0, image.cols, image.rows);
  if (grey_.empty() || inside.width < grey_.cols || inside.height < grey_.rows) return {0, 0};
  cv::Mat differences;
  cv::matchTemplate(image(inside), grey_, differences, cv::TM_SQDIFF);
  cv::Point least;
  cv::minMaxLoc(differences, nullptr, nullptr, &least);
  return inside.tl() + least - place_.tl();
}

}  // namespace uav_landing
