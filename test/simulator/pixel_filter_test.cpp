#include "simulator/approach/pixel_filter.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

TEST(PixelFilter, ItsVarianceAndWhatItLeavesAreThePixelsAndTheLenses) {
  for (const int samples : {1, 2, 4}) {
    for (const double blur : {0.0, 0.3, 0.4, 0.5, 0.9}) {
      for (const PixelFilter& filter : {PixelFilter(samples, blur), PixelFilter(samples, blur).finer()}) {
        double sum = 0, mean = 0, variance = filter.sampleSide() * filter.sampleSide() / 12;
        for (const PixelFilter::Sample& piece : filter.samples()) {
          sum += piece.weight;
          mean += piece.weight * piece.du;
          variance += piece.weight * piece.dv * piece.dv;
        }
        EXPECT_NEAR(sum, 1, 1e-6);
        EXPECT_NEAR(mean, 0, 1e-6);
        EXPECT_NEAR(variance + filter.blurLeft() * filter.blurLeft(), 1.0 / 12 + blur * blur, 1e-6)
            << samples << " samples, blur " << blur;
        EXPECT_NEAR(filter.equivalentSide() * filter.equivalentSide() / 12, variance, 1e-6);
      }
    }
  }
}

TEST(PixelFilter, ThePixelsShareAllLightOfAPointAndItsPlace) {
  for (const double blur : {0.0, 0.8}) {
    const PixelFilter filter(2, blur);
    for (const double at : {0.1, 0.37, 0.5, 0.9}) {
      double sum = 0, place = 0;
      for (int u = -2; u <= 3; ++u)
        for (int v = -2; v <= 3; ++v) {
          const double share = filter.weightOf(at - u, 0.2 - v);
          sum += share;
          place += share * u;
        }
      EXPECT_NEAR(sum, 1, 1e-12) << blur << ' ' << at;
      // Where the lens does not blur, the light is in one pixel.
      EXPECT_NEAR(place, at, blur > 0 ? 1e-12 : 0.5) << blur << ' ' << at;
    }
  }
}

}  // namespace
}  // namespace uav_landing
