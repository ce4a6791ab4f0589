#include "kernels/window/window_copy.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(CopyWindow, PutsRowsOneAfterTheOther) {
  const cv::Mat image = test::randomImage(40, 50, CV_32F, 3);
  for (const int size : {1, 3, 7, 9, 11, 13, 31}) {
    std::vector<float> out(size * size + 1, -1);
    copyWindow(image.ptr<float>(4) + 6, image.cols, size, out.data());
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i)
        ASSERT_EQ(out[j * size + i], image.at<float>(4 + j, 6 + i)) << size << ' ' << i << ' ' << j;
    EXPECT_EQ(out.back(), -1) << "behind the last row";
  }
}

TEST(WindowSums, AreThoseOfAllValues) {
  for (const int count : {1, 7, 8, 9, 121, 200}) {
    const std::vector<float> values = test::randomValues<float>(count, 0, 255, count);
    double sum = 0, squares = 0;
    for (const float value : values) {
      sum += value;
      squares += (value - 99.0) * (value - 99.0);
    }
    EXPECT_NEAR(sumOf(values.data(), count), sum, 1e-6 * sum);
    std::vector<float> less = values, squared = values;
    subtract(99, less.data(), count);
    EXPECT_NEAR(subtractAndSquare(99, squared.data(), count), squares, 1e-5 * squares);
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(less[i], values[i] - 99);
      EXPECT_EQ(squared[i], values[i] - 99);
    }
  }
}

}  // namespace
}  // namespace uav_landing
