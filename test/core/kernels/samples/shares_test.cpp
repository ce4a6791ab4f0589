#include "kernels/samples/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lanes/lanes.h"
#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(SumOfShares, IsOfTheAreasInCommon) {
  for (const int count : {0, 1, 7, 8, 9, 30}) {
    // What fills up lies on the square.
    std::vector<float> us(wholeLanes(count) + kLanes, 20), vs = us;
    const std::vector<float> u = test::randomValues<float>(count, 0, 40, 3),
                             v = test::randomValues<float>(count, 0, 40, 4);
    std::copy(u.begin(), u.end(), us.begin());
    std::copy(v.begin(), v.end(), vs.begin());
    for (const size_t first : {0U, 8U}) {
      if (first > static_cast<size_t>(count)) continue;
      const Square square{20, 20, 11};
      double expected = 0;
      for (int i = static_cast<int>(first); i < count; ++i) {
        const double across = std::max(0.0, 11.0 - std::abs(u[i] - 20)),
                     down = std::max(0.0, 11.0 - std::abs(v[i] - 20));
        expected += across * down / (11 * 11);
      }
      EXPECT_NEAR(sumOfShares(us.data(), vs.data(), first, count, square), expected, 1e-5) << count;
    }
  }
}

}  // namespace
}  // namespace uav_landing
