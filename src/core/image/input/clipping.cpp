#include "image/input/clipping.h"

#include <cmath>

namespace uav_landing {

bool isClipped(const cv::Mat& image, const Eigen::Vector2d& centre, int radius) {
  // Limit of 255 levels. It is below white, because the edges of paint are smoothed as well.
  constexpr double kWhite = 240;
  const cv::Point middle(static_cast<int>(std::lround(centre.x())),
                         static_cast<int>(std::lround(centre.y())));
  const cv::Rect window = cv::Rect(middle.x - radius, middle.y - radius, 2 * radius + 1, 2 * radius + 1) &
                          cv::Rect({0, 0}, image.size());
  if (window.empty()) return false;
  double brightest;
  cv::minMaxLoc(image(window), nullptr, &brightest);
  return brightest >= kWhite;
}

}  // namespace uav_landing
