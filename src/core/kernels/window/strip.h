#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Where the values of a strip are in an image: rows below each other, each from a place of its own on.
struct StripPlaces {
  double start;   ///< of the first row, columns of the image
  double by_row;  ///< what the start moves by from row to row
  double step;    ///< from place to place along a row

  double at(int row) const { return start + by_row * row; }
};
/// Rows and columns of a strip. stride: from row to row in memory, whole lanes; what is behind the columns
/// fills up.
struct StripSize {
  int rows, columns, stride;
};

/// Fills a strip with the values of an image, less a mean, by linear interpolation along the rows. image:
/// CV_32F; v: row of the image that the first row is in. NaN at places outside the image, anything behind the
/// columns.
void sampleStrip(const cv::Mat& image, int v, const StripPlaces& places, const StripSize& size, float mean,
                 float* strip);

/// A square window, less its mean, row by row. energy: sum of the squared values.
struct CentredWindow {
  const float* values;
  int size;
  double energy;
};

/// What is no score: there is no contrast, or a place is outside the image.
constexpr float kNoScore = -1.f;

/// Memory for sums over the columns of a strip.
struct StripColumns {
  std::vector<float> sums, squares;
};

/// Correlation of a window with what is below it, for each of the window's positions along a strip of as many
/// rows: 1 where they differ by gain and offset only. kNoScore where the strip has less than a thousandth of
/// the window's energy. stride: of the strip; count: positions, whole lanes, as many as the strip has room
/// for.
void correlateAlong(const CentredWindow& window, const float* strip, int stride, int count,
                    StripColumns& columns, float* scores);

/// The same with sums of squared differences over twice the window's energy: 1 where the strip is equal, 0
/// where it is unrelated.
void compareAlong(const CentredWindow& window, const float* strip, int stride, int count,
                  StripColumns& columns, float* scores);

}  // namespace uav_landing
