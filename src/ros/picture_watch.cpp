#include "picture_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace uav_landing {
namespace {

constexpr int kMostRepetitions = 4;  // of one pair; more are those of a camera that hangs
constexpr int kSure = 2;             // pictures in a row that came as often
// Noise alone is at 1.0, and at most at 1.4 after the sharpening of three rows that cameras do: its second
// difference has 4^2 / (2 + sqrt(2))^2. Fields half a pixel apart are above 1.6, those farther apart above 2.
constexpr double kAlternating = 1.5;
constexpr uint64_t kSaidAt = 3;         // repetitions
constexpr int kLooks = 6, kEnough = 5;  // of the pictures looked at

bool same(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::ImageConstPtr& before) {
  return before && image->data == before->data && image->width == before->width;
}

/// A black or saturated picture is like the one before it whatever the driver does. Its pixels are alike, but
/// not their bytes: those of 16 bits and of colours differ.
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
    // The first pair may have come before we looked.
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
                  ": every other row is of another picture: interlaced video, whose heights are wrong "
                  "(convert_recording --deinterlace takes one field; live, set the camera or grabber to "
                  "progressive), or a Bayer picture sent as grey");
}

std::vector<std::string> PictureWatch::news() {
  std::vector<std::string> news;
  news.swap(news_);
  return news;
}

double rowAlternation(const cv::Mat& grey) {
  constexpr int kRows = 8, kStep = 3;  // rows of a block, columns
  double fastest = 0, below = 0;
  for (int y = 0; y + kRows <= grey.rows; y += kRows) {
    for (int x = 0; x < grey.cols; x += kStep) {
      double mean = 0, parts[3] = {0, 0, 0};
      for (int i = 0; i < kRows; ++i) mean += grey.at<uint8_t>(y + i, x) / double{kRows};
      for (int i = 0; i < kRows; ++i) {
        const double window = 0.5 - 0.5 * std::cos(2 * M_PI * (i + 1) / (kRows + 1));
        const double value = window * (grey.at<uint8_t>(y + i, x) - mean);
        parts[0] += i % 2 == 0 ? value : -value;
        parts[1] += value * std::cos(2 * M_PI * 3 * i / kRows);
        parts[2] += value * std::sin(2 * M_PI * 3 * i / kRows);
      }
      fastest += parts[0] * parts[0];
      below += parts[1] * parts[1] + parts[2] * parts[2];
    }
  }
  return below > 0 ? fastest / below : fastest > 0 ? 10.0 : 0.0;
}

}  // namespace uav_landing
