#include "kernels/samples/apart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(MarkApart, ComparesTheDifferenceWithItsVariance) {
  for (const int count : {1, 7, 8, 9, 40}) {
    const std::vector<float> values = test::randomValues<float>(count, -5, 5, count);
    const std::vector<float> variances = test::randomValues<float>(count, 0.01F, 1, count + 1);
    std::vector<std::vector<float>> by;
    for (int axis = 0; axis < 3; ++axis) by.push_back(test::randomValues<float>(count, -1, 1, 50 + axis));
    constexpr float kLimit = 9, kByChange = 0.3F;
    std::vector<uchar> apart(count, 7);
    int marked = 0;
    for (int one = 0; one < count; one += 3) {
      markApart({values.data(), variances.data(), {by[0].data(), by[1].data(), by[2].data()}, count}, one,
                kLimit, kByChange, apart.data());
      for (int i = 0; i < count; ++i) {
        double change = 0;
        for (const std::vector<float>& d : by) change += std::pow(d[i] - d[one], 2);
        const double variance = variances[i] + variances[one] + kByChange * change;
        EXPECT_EQ(apart[i], std::pow(values[i] - values[one], 2) > kLimit * variance ? 1 : 0)
            << i << ' ' << one;
        marked += apart[i];
      }
    }
    if (count > 9) {
      EXPECT_GT(marked, count);
    }
  }
}

}  // namespace
}  // namespace uav_landing
