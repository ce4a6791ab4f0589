#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stereo/matching/shift_model.h"

namespace uav_landing {

/// The rows of a pair that show ground, as floats. A plane puts the pixels of the right image on those of the
/// left image. Where not both cameras see the ground, each image repeats its last common pixel along the row,
/// so that a filter finds no edge there.
class AlignedRows {
 public:
  /// Masks of the rectified images (mono8), eroded by at least two pixels.
  AlignedRows(const cv::Mat& left_mask, const cv::Mat& right_mask);

  /// Takes the rows of the left image (mono8) with ground that both cameras see. By the shift model, ground
  /// has shifts of more than least, pixels.
  void begin(const cv::Mat& left, const ShiftModel& shift, double least);
  /// Interpolates the right image (CV_32F) by a model near the one of begin().
  void align(const cv::Mat& right, const ShiftModel& model);

  /// Row of the whole images that is the first one here.
  int firstRow() const { return first_row_; }
  /// CV_32F, as wide as the whole images.
  const cv::Mat& left() const { return left_; }
  const cv::Mat& right() const { return right_; }
  /// Columns of one of these rows in which both cameras see the ground.
  const cv::Range& seen(int row) const { return seen_[row]; }

 private:
  int findFirstRow(const ShiftModel& shift, double least) const;
  /// For row v of the whole images.
  cv::Range seenColumns(const ShiftModel& model, double least, int v) const;
  /// Finds the rows, down to the last one of which both cameras see some part.
  void findRows(const ShiftModel& shift, double least);
  cv::Range readableColumns(const ShiftModel& shift, int row, int cols) const;

  cv::Size size_;
  std::vector<cv::Range> left_columns_, right_columns_;  // columns with picture, for each row of the whole
                                                         // images
  cv::Mat left_memory_, right_memory_;                   // for all rows
  int first_row_ = 0;
  cv::Mat left_, right_;
  std::vector<cv::Range> seen_;
};

}  // namespace uav_landing
