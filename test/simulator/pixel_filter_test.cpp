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

}  // namespace
}  // namespace uav_landing
