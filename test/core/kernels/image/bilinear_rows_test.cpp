#include "kernels/image/bilinear_rows.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/random_values.h"

namespace uav_landing {
namespace {

/// Pixels of a row that come from any places of an image, some of them left out.
struct Row {
  std::vector<short> places;
  std::vector<std::uint16_t> weights;
  std::vector<uchar> mask;

  Row(int count, const cv::Rect& inside, unsigned seed) {
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % n); };
    for (int u = 0; u < count; ++u) {
      places.push_back(static_cast<short>(inside.x + below(inside.width - 1)));
      places.push_back(static_cast<short>(inside.y + below(inside.height - 1)));
      weights.push_back(static_cast<std::uint16_t>(below(33) + 256 * below(33)));
      mask.push_back(below(8) == 0 ? 0 : 255);
    }
  }
  int count() const { return static_cast<int>(mask.size()); }
  int x(int u) const { return places[2 * u]; }
  int y(int u) const { return places[2 * u + 1]; }
  int right(int u) const { return weights[u] & 255; }
  int below(int u) const { return weights[u] >> 8; }

  uchar expected(const cv::Mat& image, int u) const {
    if (mask[u] == 0) return 0;
    const auto at = [&](int i, int j) { return static_cast<int>(image.at<uchar>(y(u) + j, x(u) + i)); };
    const int upper = at(0, 0) * (32 - right(u)) + at(1, 0) * right(u);
    const int lower = at(0, 1) * (32 - right(u)) + at(1, 1) * right(u);
    return static_cast<uchar>((upper * (32 - below(u)) + lower * below(u) + 512) / 1024);
  }
};

TEST(BlendRow, IsBilinearInterpolation) {
  const cv::Mat image = test::randomImage(30, 50, CV_8UC1, 3);
  for (const int count : {1, 7, 8, 31, 256, 257, 600}) {
    const Row row(count, {0, 0, image.cols, image.rows}, count);
    std::vector<uchar> out(count + 1, 77);
    blendRow(image, {row.places.data(), row.weights.data(), row.mask.data(), count}, out.data());
    for (int u = 0; u < count; ++u) ASSERT_EQ(out[u], row.expected(image, u)) << u << " of " << count;
    EXPECT_EQ(out[count], 77) << "behind the row";
  }
}

TEST(BlendWindows, IsBilinearInterpolation) {
  if (!canBlendWindows()) GTEST_SKIP() << "needs AVX2";
  const cv::Mat image = test::randomImage(30, 60, CV_8UC1, 4);
  constexpr int kPixels = SourceWindows::kPixels, kHalf = SourceWindows::kHalf;
  for (const int count : {16, 17, 32, 45}) {
    std::vector<uchar> out(count, 1), mask(count), expected(count);
    std::vector<SourceWindows> windows;
    for (int u = 0; u < count; u += kPixels) {
      const int first = std::min(u, count - kPixels);
      SourceWindows window;
      for (const int half : {0, 1}) {
        const cv::Rect inside(3 + 20 * half + first % 5, 2 + 7 * half, SourceWindows::kColumns,
                              SourceWindows::kRows);
        window.x[half] = static_cast<short>(inside.x);
        window.y[half] = static_cast<short>(inside.y);
        const Row row(kHalf, inside, 100 + first + half);
        for (int i = 0; i < kHalf; ++i) {
          const int k = half * kHalf + i, next = row.y(i) > inside.y ? SourceWindows::kNextRow : 0;
          window.place[k] = static_cast<uchar>(row.x(i) - inside.x + next);
          window.right[k] = static_cast<uchar>(row.right(i));
          window.below[k] = static_cast<uchar>(row.below(i));
          mask[first + k] = row.mask[i];
          expected[first + k] = row.expected(image, i);
        }
      }
      windows.push_back(window);
    }
    blendWindows(image, windows.data(), count, mask.data(), out.data());
    // Pixels that two windows have are those of the last one.
    for (int u = 0; u < count; ++u) ASSERT_EQ(out[u], expected[u]) << u << " of " << count;
  }
}

}  // namespace
}  // namespace uav_landing
