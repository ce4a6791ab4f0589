#include "uav_landing/match_image.h"

#include <opencv2/imgproc.hpp>

namespace uav_landing {

int coarseFactor(const cv::Size& size) {
  constexpr int kEnoughColumns = 400, kLeastRows = 150;
  int factor = 1;
  while (size.width / factor > kEnoughColumns && size.height / (2 * factor) >= kLeastRows) factor *= 2;
  return factor;
}

void MatchImage::assign(const cv::Mat& image) {
  factor = coarseFactor(image.size());
  image.convertTo(fine, CV_32F);
  if (factor > 1) {
    cv::resize(fine, coarse, cv::Size(image.cols / factor, image.rows / factor), 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(coarse, coarse, cv::Size(3, 3), 0.7);
  }
  cv::GaussianBlur(fine, fine, cv::Size(3, 3), 0.7);
  if (factor == 1) coarse = fine;
}

}  // namespace uav_landing
