#include "kernels/samples/plane_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random_values.h"

namespace uav_landing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PlaneColumns someSamples(size_t count) {
  PlaneColumns columns;
  columns.resize(count + 9);  // what is left of an earlier use
  for (std::vector<double>* column : {&columns.x, &columns.y, &columns.value, &columns.precision})
    std::fill(column->begin(), column->end(), 3.0);
  columns.resize(count);
  const auto set = [&](std::vector<double>& column, double low, double high, unsigned seed) {
    const std::vector<double> values = test::randomValues<double>(count, low, high, seed);
    std::copy(values.begin(), values.end(), column.begin());
  };
  set(columns.x, -20, 20, 3);
  set(columns.y, 0, 30, 4);
  set(columns.value, -1, 9, 5);
  set(columns.precision, 0.5, 12, 6);
  return columns;
}

double expectedValue(const PlaneColumns& c, const LinearValue& plane, size_t i) {
  return plane.x_slope * c.x[i] + plane.y_slope * c.y[i] + plane.constant;
}

TEST(PlaneSums, AreOfTheSamplesNearThePlane) {
  const LinearValue plane{0.05, 0.2, 0.3};
  for (const size_t count : {1U, 3U, 4U, 5U, 64U, 203U}) {
    PlaneColumns c = someSamples(count);
    expectValues(plane, c);
    constexpr double kFarthest = 2, kPerRatio = 1.5, kUnit = 0.05;
    const NearbyCount nearby = measureBelow(kFarthest, kPerRatio, c);
    size_t all = 0, small = 0;
    for (size_t i = 0; i < c.ratio.size(); ++i) {
      const double residual = i < count ? c.value[i] - expectedValue(c, plane, i) : 1;
      const bool near = residual <= 0 && residual > -kFarthest;
      if (i < count) {
        EXPECT_NEAR(c.expected[i], expectedValue(c, plane, i), 1e-12);
      }
      if (near) {
        EXPECT_NEAR(c.ratio[i], -residual * c.precision[i], 1e-12);
      } else {
        EXPECT_EQ(c.ratio[i], kInfinity) << i;
      }
      all += near ? 1 : 0;
      small += near && -residual * c.precision[i] * kPerRatio <= 1 ? 1 : 0;
    }
    EXPECT_EQ(nearby.all, all);
    EXPECT_EQ(nearby.small, small);

    const PlaneSums sums = addUpTukey(kUnit, c);
    PlaneSums wanted{};
    for (size_t i = 0; i < count; ++i) {
      const double expected = expectedValue(c, plane, i), residual = c.value[i] - expected;
      const double information = c.precision[i] * c.precision[i],
                   left = 1 - kUnit * residual * residual * information;
      const double w = left > 0 && expected > 0 ? left * left * information : 0;
      EXPECT_NEAR(c.weight[i], w, 1e-10) << i;
      wanted.count += w > 0 ? 1 : 0;
      wanted.w += w;
      wanted.wx += w * c.x[i];
      wanted.wy += w * c.y[i];
      wanted.wxx += w * c.x[i] * c.x[i];
      wanted.wxy += w * c.x[i] * c.y[i];
      wanted.wyy += w * c.y[i] * c.y[i];
      wanted.wd += w * c.value[i];
      wanted.wxd += w * c.x[i] * c.value[i];
      wanted.wyd += w * c.y[i] * c.value[i];
      wanted.squares += w * residual * residual;
    }
    EXPECT_EQ(sums.count, wanted.count);
    const double tolerance = 1e-11 * (wanted.wxx + wanted.wyy + 1);
    EXPECT_NEAR(sums.w, wanted.w, tolerance);
    EXPECT_NEAR(sums.wx, wanted.wx, tolerance);
    EXPECT_NEAR(sums.wy, wanted.wy, tolerance);
    EXPECT_NEAR(sums.wxx, wanted.wxx, tolerance);
    EXPECT_NEAR(sums.wxy, wanted.wxy, tolerance);
    EXPECT_NEAR(sums.wyy, wanted.wyy, tolerance);
    EXPECT_NEAR(sums.wd, wanted.wd, tolerance);
    EXPECT_NEAR(sums.wxd, wanted.wxd, tolerance);
    EXPECT_NEAR(sums.wyd, wanted.wyd, tolerance);
    EXPECT_NEAR(sums.squares, wanted.squares, tolerance);
  }
}

TEST(PlaneSums, DoNotCountWhereThePlaneIsNotAboveZero) {
  PlaneColumns c = someSamples(8);
  expectValues({0, 0, -1}, c);
  EXPECT_EQ(addUpTukey(1e-9, c).count, 0);
}

}  // namespace
}  // namespace uav_landing
