#include "kernels/samples/surface_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

TEST(PlaceOnSurface, IsThePlaneAndWhatItDoesNotHave) {
  const LinearValue plane{0.1, 0.3, 0.05}, reach{-0.2, 0.02, 0.9};
  constexpr double kScale = 40, kLeast = 0.3;
  for (const size_t count : {4U, 8U, 60U}) {
    const std::vector<double> x = test::randomValues<double>(count, -0.5, 0.5, 3),
                              y = test::randomValues<double>(count, -0.2, 0.5, 4),
                              value = test::randomValues<double>(count, 0, 6, 5),
                              flat = test::randomValues<double>(count, 0, 6, 6);
    std::vector<double> by_plane(count), expected(count), reaches(count);
    placeOnSurface(plane, reach, kScale, kLeast,
                   {x.data(), y.data(), value.data(), flat.data(), by_plane.data(), expected.data(),
                    reaches.data(), count});
    for (size_t i = 0; i < count; ++i) {
      const double there = kScale * (plane.x_slope * x[i] + plane.y_slope * y[i] + plane.constant);
      EXPECT_NEAR(by_plane[i], there, 1e-12);
      EXPECT_NEAR(expected[i], std::max(kLeast, there + value[i] - flat[i]), 1e-12);
      EXPECT_NEAR(reaches[i], kScale * (reach.x_slope * x[i] + reach.y_slope * y[i] + reach.constant), 1e-12);
    }
    EXPECT_GT(std::count(expected.begin(), expected.end(), kLeast), 0);
  }
}

}  // namespace
}  // namespace uav_landing
