#include "lines/segments/segment_scanner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/random_texture.h"

namespace uav_landing {
namespace {

const cv::Size kSize(320, 240);
// The Sobel response of an upright step is four times the step: edges of 10 grey levels, starts at 25.
const EdgeLimits kLimits{40, 100, 24, 5};

cv::Mat plain(int grey = 60) { return cv::Mat(kSize, CV_8UC1, cv::Scalar(grey)); }
cv::Mat everywhere() { return plain(255); }

void drawBar(cv::Mat& image, const cv::Rect& bar, int grey = 180) {
  cv::rectangle(image, bar, cv::Scalar(grey), cv::FILLED);
}

std::vector<RoughSegment> find(const cv::Mat& image, const EdgeLimits& limits = kLimits) {
  return SegmentScanner().find(image, everywhere(), limits);
}

double length(const RoughSegment& segment) { return (segment.b - segment.a).norm(); }

/// Grey levels of an edge between 60 and 60 + step at a column of its own in each row, some pixels wide.
template <class Column, class Step>
cv::Mat edgeAlong(const Column& column, const Step& step) {
  cv::Mat image = plain();
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(60 + step(v) / (1 + std::exp(column(v) - u)));
  return image;
}

TEST(SegmentScanner, FindsEachSideOfABarOnceWithItsBrighterSide) {
  cv::Mat image = plain();
  drawBar(image, {100, 60, 80, 120});
  const std::vector<RoughSegment> segments = find(image);
  ASSERT_EQ(segments.size(), 4U);
  const double wanted[4][3] = {{99.5, 1, 120}, {179.5, -1, 120}, {59.5, 1, 80}, {179.5, -1, 80}};
  bool seen[4] = {};
  for (const RoughSegment& segment : segments) {
    const int axis = std::abs(segment.brighter.x()) > 0.5 ? 0 : 1;
    const int index = 2 * axis + (segment.brighter[axis] < 0 ? 1 : 0);
    EXPECT_FALSE(seen[index]);
    seen[index] = true;
    EXPECT_NEAR(segment.a[axis], wanted[index][0], 1.0);
    EXPECT_NEAR(segment.b[axis], wanted[index][0], 1.0);
    EXPECT_EQ(segment.brighter[axis], wanted[index][1]);
    EXPECT_NEAR(length(segment), wanted[index][2], 6);
  }
}

TEST(SegmentScanner, MissesNoLineOfTheLeastLengthWhereverItLies) {
  for (int angle = 0; angle < 180; angle += 15)
    for (int shift = 0; shift < 8; ++shift) {
      cv::Mat image = plain();
      const cv::RotatedRect bar({150.f + shift, 120.3f + shift}, {30, 30}, angle + 3.f);
      cv::Point2f corners[4];
      bar.points(corners);
      std::vector<cv::Point> polygon;
      for (const cv::Point2f& p : corners) polygon.emplace_back(cvRound(16 * p.x), cvRound(16 * p.y));
      cv::fillConvexPoly(image, polygon, cv::Scalar(200), cv::LINE_AA, 4);
      EXPECT_EQ(find(image).size(), 4U) << angle << ' ' << shift;
    }
}

TEST(SegmentScanner, LeavesOutWhatIsShorterThanTheLeastLength) {
  cv::Mat image = plain();
  drawBar(image, {100, 60, 19, 19});
  EXPECT_TRUE(find(image).empty());
  drawBar(image, {200, 60, 30, 30});
  EXPECT_EQ(find(image).size(), 4U);
}

TEST(SegmentScanner, StartsFromStrongEdgesAndFollowsThemWhileTheyAreWeak) {
  const auto upright = [](int) { return 150.0; };
  const auto sharp = [&](double step) {
    cv::Mat image = plain();
    image.colRange(150, kSize.width) += step;
    return image;
  };
  EXPECT_TRUE(find(sharp(24)).empty());
  ASSERT_EQ(find(sharp(26)).size(), 1U);
  // Contrast that falls from 240 to nothing from the top to the bottom. The response of this edge is 1.8
  // times the step: strong to row 184, weak to row 217 (half the weak response is asked of it, as it may lie
  // at 45 degrees: row 228).
  const std::vector<RoughSegment> fading = find(edgeAlong(upright, [](int v) { return 240.0 - v; }));
  ASSERT_EQ(fading.size(), 1U);
  EXPECT_GT(std::max(fading[0].a.y(), fading[0].b.y()), 205);
  EXPECT_LT(std::max(fading[0].a.y(), fading[0].b.y()), 234);
}

TEST(SegmentScanner, BridgesGapsUpToTheGivenLengthOnly) {
  cv::Mat image = plain();
  drawBar(image, {100, 30, 12, 60});
  drawBar(image, {100, 104, 12, 60});
  EdgeLimits limits = kLimits;
  const auto lengths = [&] {
    std::vector<int> rounded;  // in units of 20 pixels
    for (const RoughSegment& segment : find(image, limits)) rounded.push_back(cvRound(length(segment) / 20));
    return rounded;
  };
  EXPECT_EQ(lengths(), std::vector<int>({3, 3, 3, 3}));
  limits.max_gap = 20;
  EXPECT_EQ(lengths(), std::vector<int>({7, 7}));
}

TEST(SegmentScanner, LeavesOutLinesThatAreMostlyGaps) {
  cv::Mat image = plain();
  for (int v = 4; v + 16 < kSize.height; v += 28) drawBar(image, {100, v, 12, 16});
  EdgeLimits limits = kLimits;
  limits.max_gap = 16;
  EXPECT_TRUE(find(image, limits).empty());
}

TEST(SegmentScanner, LeavesOutEdgesThatAreNotStraight) {
  const auto strong = [](int) { return 120.0; };
  EXPECT_EQ(find(edgeAlong([](int v) { return 150.0 + 0.2 * v; }, strong)).size(), 1U);
  // To and fro by 0.9 pixels.
  EXPECT_TRUE(find(edgeAlong([](int v) { return v / 5 % 2 == 0 ? 149.1 : 150.9; }, strong)).empty());
}

TEST(SegmentScanner, FindsFewLinesInTexture) {
  const test::RandomTexture texture(7);
  cv::Mat image = plain();
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u)
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(120 + 30 * texture.at(u / 4.0, v / 4.0));
  // Without the look at the direction along the edge there are hundreds of lines, without that at their
  // scatter 80.
  EXPECT_LE(find(image).size(), 70U);
}

TEST(SegmentScanner, StartsAndStaysOnTheGround) {
  cv::Mat image = plain();
  drawBar(image, {100, 0, 100, kSize.height});
  for (int border = 60; border < 72; ++border) {
    cv::Mat ground = cv::Mat::zeros(kSize, CV_8UC1);
    ground.rowRange(border, border + 100) = 255;
    const std::vector<RoughSegment> segments = SegmentScanner().find(image, ground, kLimits);
    ASSERT_EQ(segments.size(), 2U);
    for (const RoughSegment& segment : segments) {
      EXPECT_GE(std::min(segment.a.y(), segment.b.y()), border);
      EXPECT_LT(std::max(segment.a.y(), segment.b.y()), border + 100);
      EXPECT_GT(length(segment), 90);
    }
  }
}

TEST(SegmentScanner, LooksAtImagesOfAnySizeWithoutHarm) {
  SegmentScanner scanner;
  for (int rows = 1; rows < 7; ++rows)
    for (int columns = 1; columns < 7; ++columns) {
      cv::Mat image(rows, columns, CV_8UC1);
      cv::RNG(rows + 10 * columns).fill(image, cv::RNG::UNIFORM, 0, 256);
      EXPECT_TRUE(scanner.find(image, cv::Mat(rows, columns, CV_8UC1, cv::Scalar(255)), kLimits).empty());
    }
}

}  // namespace
}  // namespace uav_landing
