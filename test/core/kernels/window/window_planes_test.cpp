#include "kernels/window/window_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// A pixel of a window: less the grey level in the middle, and the gradient as the sums have it.
struct Pixel {
  double a, x, y, across, down;
};
std::vector<Pixel> pixelsOf(const cv::Mat_<float>& image, int u, int v, int radius) {
  std::vector<Pixel> pixels;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i)
      pixels.push_back({image(v + j, u + i) - image(v, u),
                        -0.5 * (image(v + j, u + i + 1) - image(v + j, u + i - 1)),
                        -0.5 * (image(v + j + 1, u + i) - image(v + j - 1, u + i)), double(i), double(j)});
  return pixels;
}

/// terms: function of a pixel.
template <class Terms>
void expectSum(const std::vector<Pixel>& pixels, double found, const Terms& terms) {
  double sum = 0, size = 0;
  for (const Pixel& pixel : pixels) {
    sum += terms(pixel);
    size += std::abs(terms(pixel));
  }
  EXPECT_NEAR(found, sum, 1e-5 * size + 1e-9);
}

TEST(WindowPlanes, HaveTheSumsOverAllPixels) {
  const cv::Mat_<float> image = test::randomImage(50, 60, CV_32F, 3);
  for (const int radius : {1, 2, 3, 4, 5, 6, 10}) {
    const std::vector<Pixel> pixels = pixelsOf(image, 30, 25, radius);
    const WindowPlanes planes(image, 30, 25, radius);
    EXPECT_EQ(planes.middle(), image(25, 30));
    EXPECT_EQ(planes.pixels(), static_cast<int>(pixels.size()));
    const auto expect = [&](double found, auto terms) { expectSum(pixels, found, terms); };
    using P = const Pixel&;
    const WindowPlanes::OwnSums own = planes.sums();
    expect(own.a, [](P p) { return p.a; });
    expect(own.x, [](P p) { return p.x; });
    expect(own.y, [](P p) { return p.y; });
    expect(own.aa, [](P p) { return p.a * p.a; });
    expect(own.ax, [](P p) { return p.a * p.x; });
    expect(own.ay, [](P p) { return p.a * p.y; });
    expect(own.xx, [](P p) { return p.x * p.x; });
    expect(own.xy, [](P p) { return p.x * p.y; });
    expect(own.yy, [](P p) { return p.y * p.y; });
    const WindowPlanes::DistanceSums sums = planes.distanceSums();
    for (const bool down : {false, true}) {
      const WindowPlanes::MomentSums& moments = sums.moments[down ? 1 : 0];
      const auto distance = [down](P p) { return down ? p.down : p.across; };
      expect(moments.x, [&](P p) { return distance(p) * p.x; });
      expect(moments.y, [&](P p) { return distance(p) * p.y; });
      expect(moments.xx, [&](P p) { return distance(p) * p.x * p.x; });
      expect(moments.xy, [&](P p) { return distance(p) * p.x * p.y; });
      expect(moments.yy, [&](P p) { return distance(p) * p.y * p.y; });
    }
    const auto s = [](P p) { return p.x * p.across + p.y * p.down; };
    expect(sums.growth.s_across, [&](P p) { return s(p) * p.across; });
    expect(sums.growth.s_down, [&](P p) { return s(p) * p.down; });
    expect(sums.growth.x_across, [&](P p) { return s(p) * p.x * p.across; });
    expect(sums.growth.x_down, [&](P p) { return s(p) * p.x * p.down; });
    expect(sums.growth.y_across, [&](P p) { return s(p) * p.y * p.across; });
    expect(sums.growth.y_down, [&](P p) { return s(p) * p.y * p.down; });
  }
}

TEST(WindowPlanes, AreMultipliedWithAnotherWindow) {
  const cv::Mat_<float> image = test::randomImage(50, 60, CV_32F, 4),
                        other = test::randomImage(50, 60, CV_32F, 5);
  for (const int radius : {1, 3, 5, 6, 10}) {
    const std::vector<Pixel> pixels = pixelsOf(image, 30, 25, radius);
    const WindowPlanes planes(image, 30, 25, radius);
    const int size = planes.size();
    WindowValues values;
    values.fill(1e6F);  // what fills up
    std::vector<double> b;
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        values[j * planes.stride() + i] = other(j, i);
        b.push_back(other(j, i) - planes.middle());
      }
    const WindowPlanes::OtherSums sums = planes.multiply(values);
    double b1 = 0, bb = 0, ba = 0, bx = 0, by = 0;
    for (size_t k = 0; k < b.size(); ++k) {
      b1 += b[k];
      bb += b[k] * b[k];
      ba += b[k] * pixels[k].a;
      bx += b[k] * pixels[k].x;
      by += b[k] * pixels[k].y;
    }
    const double tolerance = 1e-5 * bb;
    EXPECT_NEAR(sums.b, b1, tolerance);
    EXPECT_NEAR(sums.bb, bb, tolerance);
    EXPECT_NEAR(sums.ba, ba, tolerance);
    EXPECT_NEAR(sums.bx, bx, tolerance);
    EXPECT_NEAR(sums.by, by, tolerance);
  }
}

}  // namespace
}  // namespace uav_landing
