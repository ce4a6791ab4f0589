#include "kernels/edges/edge_starts.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(SobelRow, HasTheResponsesOfBothKernels) {
  for (const int columns : {3, 17, 33, 100}) {
    const cv::Mat image = test::randomImage(3, columns, CV_8UC1, columns);
    std::vector<short> along(columns, 7), down(columns, 7);
    sobelRow(image.ptr<uchar>(0), image.ptr<uchar>(1), image.ptr<uchar>(2), columns, along.data(),
             down.data());
    for (int u = 1; u + 1 < columns; ++u) {
      int wanted_along = 0, wanted_down = 0;
      for (int k = -1; k <= 1; ++k) {
        const int weight = k == 0 ? 2 : 1;
        wanted_along += weight * (image.at<uchar>(1 + k, u + 1) - image.at<uchar>(1 + k, u - 1));
        wanted_down += weight * (image.at<uchar>(2, u + k) - image.at<uchar>(0, u + k));
      }
      ASSERT_EQ(along[u], wanted_along) << u << " of " << columns;
      ASSERT_EQ(down[u], wanted_down) << u << " of " << columns;
    }
    EXPECT_EQ(along.front(), 7);
    EXPECT_EQ(along.back(), 7);
  }
}

TEST(MarkEdgeStarts, AreMaximaAlongTheRow) {
  for (const int columns : {5, 18, 90, 200}) {
    std::vector<short> along, down;
    // Few different numbers, so that neighbours are equal often.
    for (const float value : test::randomValues<float>(columns, -9, 9, columns))
      along.push_back(static_cast<short>(static_cast<int>(value) * 100));
    for (const float value : test::randomValues<float>(columns, -9, 9, columns + 1))
      down.push_back(static_cast<short>(static_cast<int>(value) * 100));
    constexpr short kLeast = 500;
    std::vector<uchar> starts(columns, 9);
    markEdgeStarts(along.data(), down.data(), columns, kLeast, starts.data());
    for (int u = 2; u + 2 < columns; ++u) {
      const int here = std::abs(along[u]), side = std::abs(down[u]);
      const bool wanted = here > std::abs(along[u - 1]) && here >= std::abs(along[u + 1]) && here >= side &&
                          here + side >= kLeast;
      ASSERT_EQ(starts[u], wanted ? 1 : 0) << u << " of " << columns;
    }
    EXPECT_EQ(starts[1], 9);
    EXPECT_EQ(starts[columns - 2], 9);
  }
}

}  // namespace
}  // namespace uav_landing
