#include "kernels/image/transpose.h"

#include <gtest/gtest.h>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(Transpose, MakesRowsOfColumns) {
  for (const int rows : {1, 15, 16, 17, 40})
    for (const int columns : {3, 16, 31, 50}) {
      // A part of a larger image, so that rows are farther apart than they are long.
      const cv::Mat larger = test::randomImage(rows + 3, columns + 5, CV_8UC1, rows + columns);
      const cv::Mat image = larger(cv::Rect(2, 1, columns, rows));
      cv::Mat transposed(columns, rows, CV_8UC1);
      transpose(image, transposed);
      ASSERT_EQ(transposed.size(), cv::Size(rows, columns));
      for (int v = 0; v < rows; ++v)
        for (int u = 0; u < columns; ++u)
          ASSERT_EQ(transposed.at<uchar>(u, v), image.at<uchar>(v, u)) << rows << ' ' << columns;
    }
}

}  // namespace
}  // namespace uav_landing
