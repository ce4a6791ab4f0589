#include "far/picture_patch.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace uav_landing {
namespace {

constexpr int kMostRows = 24, kMostColumns = 32;

int difference(const uchar* a, const uchar* b, int count, int stride) {
  int sum = 0;
  if (stride == 1) {
    for (int i = 0; i < count; ++i) sum += std::abs(a[i] - b[i]);
  } else {
    for (int i = 0; i < count; i += stride) sum += std::abs(a[i] - b[i]);
  }
  return sum;
}

}  // namespace

void PicturePatch::take(const cv::Mat& image, const cv::Rect& place) {
  place_ = place & cv::Rect(0, 0, image.cols, image.rows);
  grey_ = place_.area() > 0 ? image(place_).clone() : cv::Mat();
}

cv::Point PicturePatch::movement(const cv::Mat& image, int reach) const {
  const int rows = std::max(1, place_.height / kMostRows), columns = std::max(1, place_.width / kMostColumns);
  cv::Point best(0, 0);
  long least = std::numeric_limits<long>::max();
  for (int dv = -reach; dv <= reach; ++dv) {
    if (place_.y + dv < 0 || place_.y + dv + place_.height > image.rows) continue;
    for (int du = -reach; du <= reach; ++du) {
      if (place_.x + du < 0 || place_.x + du + place_.width > image.cols) continue;
      long sum = 0;
      for (int v = 0; v < place_.height && sum < least; v += rows)
        sum += difference(grey_.ptr<uchar>(v), image.ptr<uchar>(place_.y + dv + v) + place_.x + du,
                          place_.width, columns);
      if (sum >= least) continue;
      least = sum;
      best = {du, dv};
    }
  }
  return best;
}

}  // namespace uav_landing
