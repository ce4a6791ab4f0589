#pragma once

#include <sensor_msgs/Image.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace uav_landing {

/// What drivers do to pictures: a pair once more, bit by bit, under a new stamp, and rows of two times.
/// Thread safe only in so far as one thread uses it.
class PictureWatch {
 public:
  /// Whether a pair is to be left out because its pictures are those of the pair before. Only where they come
  /// so all the time, each as often: what a camera that hangs sends is not left out. At the start twice is
  /// taken for the usual, until a picture comes once.
  bool isRepetition(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right);
  /// Looks at the rows of a raw grey picture of this topic.
  void look(const cv::Mat& grey, const std::string& topic);

  /// What a person should know, each of it once.
  std::vector<std::string> news();
  /// Pairs that were left out.
  uint64_t repetitions() const { return left_out_; }

 private:
  sensor_msgs::ImageConstPtr left_, right_;  // of the pair before
  int pictures_ = 0, repeated_ = 0;          // so far, and pairs in a row that repeat the same ones
  int usual_ = 1, times_ = 2;  // repetitions of the pictures before, and of how many of them in a row
  uint64_t left_out_ = 0;
  bool said_repetitions_ = false;

  int looks_ = 0, alternating_ = 0;
  bool said_rows_ = false;
  std::vector<std::string> news_;
};

}  // namespace uav_landing
