#pragma once

#include <opencv2/core.hpp>

namespace uav_landing {

/// A slanted row across an image: its vertical place by column.
struct SlantedRow {
  double first, slope;  ///< at the first column, and per column
};

/// Values of an image (CV_32F) along such a row, one per column, interpolated down the columns by parabolas
/// (interpolation.h). Places above the second row or in the last two rows count as just inside.
void sampleSlantedRow(const cv::Mat& image, const SlantedRow& row, float* out);

}  // namespace uav_landing
