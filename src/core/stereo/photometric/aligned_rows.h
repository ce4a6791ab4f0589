#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/shift_model.h"

namespace uav_landing {

/// The ground's rows of a pair as floats, with the right image's pixels on the places of the left one's, as a
/// plane says. Where not both cameras see the ground a row is filled up with the last pixel that they do, in
/// each image with its own: a filter finds no edge there.
class AlignedRows {
 public:
  /// Masks of the rectified images (mono8), eroded by at least two pixels.
  AlignedRows(const cv::Mat& left_mask, const cv::Mat& right_mask);

  /// Takes the rows of the left image (mono8) that have ground by the shift model, shifts of more than least,
  /// pixels, which both cameras see.
  void begin(const cv::Mat& left, const ShiftModel& shift, double least);
  /// Interpolates the right image (CV_32F) by a model that is near the one of begin().
  void align(const cv::Mat& right, const ShiftModel& model);

  /// Row of the whole images that the first one here is.
  int firstRow() const { return first_row_; }
  /// CV_32F, as wide as the whole images.
  const cv::Mat& left() const { return left_; }
  const cv::Mat& right() const { return right_; }
  /// Columns of one of the rows here whose ground both cameras see.
  const cv::Range& seen(int row) const { return seen_[row]; }

 private:
  int findFirstRow(const ShiftModel& shift, double least) const;
  /// Of row v of the whole images.
  cv::Range seenColumns(const ShiftModel& model, double least, int v) const;
  /// The rows to the last one that both cameras see some of.
  void findRows(const ShiftModel& shift, double least);
  cv::Range readableColumns(const ShiftModel& shift, int row, int cols) const;

  cv::Size size_;
  std::vector<cv::Range> left_columns_, right_columns_;  // with picture, of each row of the whole images
  cv::Mat left_memory_, right_memory_;                   // for all rows
  int first_row_ = 0;
  cv::Mat left_, right_;
  std::vector<cv::Range> seen_;
};

}  // namespace uav_landing
