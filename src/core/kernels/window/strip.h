#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace uav_landing {

/// Places of a strip's values in an image: rows below each other, each with its own start.
struct StripPlaces {
  double start;   ///< of the first row, columns of the image
  double by_row;  ///< change of the start from row to row
  double step;    ///< from place to place along a row

  double at(int row) const { return start + by_row * row; }
};
/// Rows and columns of a strip. stride: from row to row in memory, whole lanes; values behind the columns
/// fill them up.
struct StripSize {
  int rows, columns, stride;
};

/// Fills a strip with the values of an image minus a mean, by linear interpolation along the rows. image:
/// CV_32F. v: row of the image for the first row of the strip. Places outside the image are NaN; behind the
/// columns is anything.
void sampleStrip(const cv::Mat& image, int v, const StripPlaces& places, const StripSize& size, float mean,
                 float* strip);

/// A square window minus its mean, row by row. energy: sum of the squared values.
struct CentredWindow {
  const float* values;
  int size;
  double energy;
};

/// Score of a place without contrast or outside the image.
constexpr float kNoScore = -1.f;

/// Memory for sums over the columns of a strip.
struct StripColumns {
  std::vector<float> sums, squares;
};

/// Correlation of a window with each of its positions along a strip of as many rows: 1 when they differ by
/// gain and offset only. kNoScore when the strip has less than a thousandth of the window's energy. stride:
/// of the strip. count: positions, whole lanes, for which the strip has room.
void correlateAlong(const CentredWindow& window, const float* strip, int stride, int count,
                    StripColumns& columns, float* scores);

/// The same with sums of squared differences over twice the window's energy: 1 when the strip is equal, 0
/// when it is unrelated.
void compareAlong(const CentredWindow& window, const float* strip, int stride, int count,
                  StripColumns& columns, float* scores);

}  // namespace uav_landing
