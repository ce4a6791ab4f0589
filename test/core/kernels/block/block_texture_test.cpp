#include "kernels/block/block_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// What single pixels of an image are.
struct Grey {
  const cv::Mat& image;

  double at(int u, int v) const { return image.at<uchar>(v, u); }
  double sobel(int u, int v) const {
    const auto difference = [&](int row) { return at(u + 1, row) - at(u - 1, row); };
    return difference(v - 1) + 2 * difference(v) + difference(v + 1);
  }
  /// Of fourth order.
  double along(int u, int v) const {
    return (8 * (at(u + 1, v) - at(u - 1, v)) - (at(u + 2, v) - at(u - 2, v))) / 12;
  }
  double down(int u, int v) const {
    return (8 * (at(u, v + 1) - at(u, v - 1)) - (at(u, v + 2) - at(u, v - 2))) / 12;
  }
};

TEST(BlockTexture, HasTheSumsOverItsPixels) {
  const cv::Mat image = test::randomImage(30, 60, CV_8UC1, 3);
  const Grey grey{image};
  for (const auto& [u0, v0] : {std::pair(2, 2), std::pair(17, 9), std::pair(60 - kBlockWidth - 2, 20)}) {
    double grey_mean = 0, slope_mean = 0, squares = 0;
    for (int v = v0; v < v0 + kBlockHeight; ++v)
      for (int u = u0; u < u0 + kBlockWidth; ++u) {
        grey_mean += grey.at(u, v) / kBlockPixels;
        slope_mean += grey.sobel(u, v) / 8 / kBlockPixels;
        squares += std::pow(grey.sobel(u, v), 2);
      }
    EXPECT_NEAR(slopeEnergy(image.ptr<uchar>(v0) + u0, static_cast<std::ptrdiff_t>(image.step)),
                squares - kBlockPixels * std::pow(8 * slope_mean, 2), 1.001);

    BlockTexture texture;
    measureTexture(image, u0, v0, texture);
    double gg = 0, ss = 0, gs = 0, mu = 0, mv = 0, ag = 0, as = 0, dg = 0, ds = 0;
    for (int y = 0; y < kBlockHeight; ++y)
      for (int x = 0; x < kBlockWidth; ++x) {
        const double g = grey.at(u0 + x, v0 + y) - grey_mean, s = grey.sobel(u0 + x, v0 + y) / 8 - slope_mean;
        EXPECT_NEAR(texture.grey[y * kBlockWidth + x], g, 1e-4);
        EXPECT_NEAR(texture.slope[y * kBlockWidth + x], s, 1e-4);
        gg += g * g;
        ss += s * s;
        gs += g * s;
        mu += s * s * x;
        mv += s * s * y;
        ag += grey.along(u0 + x, v0 + y) * g;
        as += grey.along(u0 + x, v0 + y) * s;
        dg += grey.down(u0 + x, v0 + y) * g;
        ds += grey.down(u0 + x, v0 + y) * s;
      }
    EXPECT_NEAR(texture.grey_energy, gg, 1e-5 * gg);
    EXPECT_NEAR(texture.slope_energy, ss, 1e-5 * ss);
    EXPECT_NEAR(texture.both, gs, 1e-5 * gg);
    EXPECT_NEAR(texture.moment_u, mu, 1e-5 * mu);
    EXPECT_NEAR(texture.moment_v, mv, 1e-5 * mv);
    EXPECT_NEAR(texture.along_grey, ag, 1e-5 * gg);
    EXPECT_NEAR(texture.along_slope, as, 1e-5 * gg);
    EXPECT_NEAR(texture.down_grey, dg, 1e-5 * gg);
    EXPECT_NEAR(texture.down_slope, ds, 1e-5 * gg);
  }
}

}  // namespace
}  // namespace uav_landing
