#include "picture_watch.h"

#include <algorithm>
#include <functional>

#include "image/input/row_alternation.h"

namespace uav_landing {
namespace {

constexpr int kMostRepetitions = 4;  // of one pair; a camera that repeats more often is frozen
constexpr int kSure = 2;             // images in a row that came equally often
// Noise alone is at 1.0. Cameras sharpen over three rows, and then it is at 1.4 at most: its second
// difference has 4^2 / (2 + sqrt(2))^2. Fields half a pixel apart are above 1.6, and those farther apart are
// above 2.
constexpr double kAlternating = 1.5;
constexpr uint64_t kSaidAt = 3;         // repetitions
constexpr int kLooks = 6, kEnough = 5;  // of the images that were looked at

bool same(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::ImageConstPtr& before) {
  return before && image->data == before->data && image->width == before->width;
}

/// Whether an image is black or saturated. Such an image equals the previous one whatever the driver does.
/// Pixels are compared, because bytes differ within a pixel of 16 bits or of colours.
bool uniform(const sensor_msgs::ImageConstPtr& image) {
  const size_t pixel = std::max<size_t>(1, image->width > 0 ? image->step / image->width : 1);
  if (pixel >= image->data.size()) return true;
  return std::equal(image->data.begin() + static_cast<std::ptrdiff_t>(pixel), image->data.end(),
                    image->data.begin());
}

}  // namespace

bool PictureWatch::isRepetition(const sensor_msgs::ImageConstPtr& left,
                                const sensor_msgs::ImageConstPtr& right) {
  const bool once_more = same(left, left_) && same(right, right_) && !uniform(left) && !uniform(right);
  left_ = left;
  right_ = right;
  if (!once_more) {
    // The first pair may have come before this object existed.
    if (++pictures_ > 2) {
      times_ = repeated_ > 0 && repeated_ == usual_ ? times_ + 1 : 1;
      usual_ = repeated_;
    }
    repeated_ = 0;
    return false;
  }
  ++repeated_;
  if (usual_ == 0 || times_ < kSure || repeated_ > usual_ || repeated_ > kMostRepetitions) return false;
  ++left_out_;
  if (left_out_ >= kSaidAt && !said_repetitions_) {
    said_repetitions_ = true;
    news_.push_back(
        "each pair of images comes " + std::to_string(usual_ + 1) +
        " times, bit by bit the same under new stamps: the driver runs faster than the cameras; the "
        "repetitions are left out");
  }
  return true;
}

void PictureWatch::look(const cv::Mat& grey, const std::string& topic) {
  if (said_rows_) return;
  if (looks_ == kLooks) looks_ = alternating_ = 0;
  ++looks_;
  if (rowAlternation(grey) > kAlternating) ++alternating_;
  if (alternating_ < kEnough) return;
  said_rows_ = true;
  news_.push_back(topic +
                  ": every other row is of another image: interlaced video, whose heights are wrong "
                  "(convert_recording --deinterlace takes one field; live, set the camera or grabber to "
                  "progressive), or a Bayer image sent as grey");
}

std::vector<std::string> PictureWatch::news() {
  std::vector<std::string> news;
  news.swap(news_);
  return news;
}

}  // namespace uav_landing
