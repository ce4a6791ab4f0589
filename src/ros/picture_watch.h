#pragma once

#include <sensor_msgs/Image.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace uav_landing {

/// Detects what drivers do to images: the same pair comes again, bit by bit, under a new stamp, or rows
/// belong to two different times. For use by one thread.
class PictureWatch {
 public:
  /// Whether to skip a pair because its images are those of the previous pair. It does so only when all pairs
  /// are repeated equally often, so images of a frozen camera are not skipped. At the start it assumes that
  /// every image comes twice, until one comes once.
  bool isRepetition(const sensor_msgs::ImageConstPtr& left, const sensor_msgs::ImageConstPtr& right);
  /// Looks at the rows of a raw grey image of this topic.
  void look(const cv::Mat& grey, const std::string& topic);

  /// Messages for people, each one once.
  std::vector<std::string> news();
  /// Number of pairs that were skipped.
  uint64_t repetitions() const { return left_out_; }

 private:
  sensor_msgs::ImageConstPtr left_, right_;  // of the previous pair
  int pictures_ = 0, repeated_ = 0;          // images so far; consecutive pairs that repeat the same ones
  int usual_ = 1, times_ = 2;  // repetitions of earlier images, and how many images in a row had this number
  uint64_t left_out_ = 0;
  bool said_repetitions_ = false;

  int looks_ = 0, alternating_ = 0;
  bool said_rows_ = false;
  std::vector<std::string> news_;
};

}  // namespace uav_landing
