#include "kernels/edges/falls.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(MarkFalls, AreWhereGreysFallMost) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    cv::Mat image = test::randomImage(1, 60, CV_8UC1, seed);
    if (seed % 2 == 1) image = (image / 64) * 64;  // equal neighbours
    const uchar* middle = image.ptr<uchar>() + 30;
    for (const int sign : {1, -1})
      for (const int least : {0, 1, 40, 255}) {
        const auto fall = [&](int k) { return std::max(0, middle[k - sign] - middle[k + sign]); };
        unsigned wanted = 0;
        for (int k = -kFallReach; k <= kFallReach; ++k)
          if (fall(k) >= least && fall(k) >= fall(k - 1) && fall(k) >= fall(k + 1))
            wanted |= 1U << (k + kFallReach);
        EXPECT_EQ(markFalls(middle, sign, least), wanted) << seed << ' ' << sign << ' ' << least;
      }
  }
}

}  // namespace
}  // namespace uav_landing
