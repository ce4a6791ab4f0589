#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// A row across an image that goes aslant: how far down it is, by column.
struct SlantedRow {
  double first, slope;  ///< at the first column, and by column
};

/// Values of an image (CV_32F) along such a row, one for each column, interpolated down the columns by
/// parabolas (interpolation.h). Places above the second row and in the last two count as if they were just
/// inside.
void sampleSlantedRow(const cv::Mat& image, const SlantedRow& row, float* out);

}  // namespace uav_landing
