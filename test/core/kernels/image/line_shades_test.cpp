#include "kernels/image/line_shades.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Greys of which every so many is not known; 0: all are.
LineGreys someGreys(int unknown_each, unsigned seed) {
  LineGreys greys;
  const std::vector<float> values = test::randomValues<float>(kLineSamples, 0, 255, seed);
  for (int i = 0; i < kLineSamples; ++i)
    greys[i] =
        unknown_each > 0 && i % unknown_each == 0 ? std::numeric_limits<float>::quiet_NaN() : values[i];
  return greys;
}

TEST(LineShades, AreOfTheGreysThatAreKnown) {
  for (const int unknown_each : {0, 1, 2, 7, 95}) {
    const LineGreys greys = someGreys(unknown_each, 3 + unknown_each);
    std::vector<float> sorted;
    std::copy_if(greys.begin(), greys.end(), std::back_inserter(sorted),
                 [](float g) { return !std::isnan(g); });
    std::sort(sorted.begin(), sorted.end());
    KnownGreys known;
    takeKnown(greys, known);
    EXPECT_EQ(known.count, static_cast<int>(sorted.size()));
    EXPECT_EQ(known.darkest, sorted.empty() ? std::numeric_limits<float>::infinity() : sorted.front());
    for (size_t rank = 0; rank < sorted.size(); rank += 5) {
      EXPECT_EQ(orderStatistic(known.greys, static_cast<int>(rank), 100.F), sorted[rank]);
      EXPECT_EQ(countFrom(sorted[rank], known), static_cast<int>(sorted.size() - rank));
    }
    EXPECT_EQ(countFrom(256, known), 0);
    LineShades shades;
    constexpr float kDark = 60, kLight = 190;
    findShades(known, kDark, kLight, shades);
    for (int i = 0; i < kLineSamples; ++i) {
      const float level = (greys[i] - kDark) / (kLight - kDark);
      const int expected = std::isnan(greys[i]) ? kUnknownShade
                           : level < 0.35F      ? -1
                           : level > 0.65F      ? 1
                                                : kBetweenShade;
      EXPECT_EQ(shades[i], expected) << i;
    }
  }
}

}  // namespace
}  // namespace uav_landing
