#include "uav_landing/match_image.h"

#include "smoothing.h"

namespace uav_landing {

int coarseFactor(const cv::Size& size) {
  constexpr int kEnoughColumns = 400, kLeastRows = 150;
  int factor = 1;
  while (size.width / factor > kEnoughColumns && size.height / (2 * factor) >= kLeastRows) factor *= 2;
  return factor;
}

void MatchImage::assign(const cv::Mat& image) {
  factor = coarseFactor(image.size());
  smooth(image, fine);
  if (factor == 1) {
    coarse = fine;
  } else {
    smoothReduced(image, factor, coarse);
  }
}

}  // namespace uav_landing
