#include "image/windows/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <set>

#include "support/random_texture.h"

namespace uav_landing {
namespace {

constexpr double kQuality = 1e-7, kDistance = 4, kHarrisK = 0.04;

/// Texture whose contrast falls from left to right by a factor of 20.
cv::Mat fadingTexture(int width, int height) {
  const test::RandomTexture texture(4);
  cv::Mat image(height, width, CV_8UC1);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image.at<uchar>(v, u) = cv::saturate_cast<uchar>(120 + 40 * std::pow(20, -double(u) / width) *
                                                                 texture.at(u / 3.0, v / 3.0));
  return image;
}

cv::Mat everywhere(const cv::Mat& image) { return cv::Mat(image.size(), CV_8UC1, cv::Scalar(255)); }

std::vector<cv::Point> find(const cv::Mat& image, const cv::Mat& mask, int count) {
  return findCorners(image, mask, {count, kQuality, kDistance, kHarrisK});
}

TEST(Corners, AreTheCornersOfASquare) {
  cv::Mat image(60, 80, CV_8UC1, cv::Scalar(40));
  cv::rectangle(image, cv::Rect(20, 15, 31, 27), cv::Scalar(200), cv::FILLED);
  const std::vector<cv::Point> corners =
      findCorners(image, everywhere(image), {10, 0.1, kDistance, kHarrisK});
  ASSERT_EQ(corners.size(), 4U);
  // The response of a 3x3 window peaks within a pixel or so of the geometric corner; sorted by row.
  for (const cv::Point expected :
       {cv::Point(20, 15), cv::Point(50, 15), cv::Point(20, 41), cv::Point(50, 41)})
    EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](const cv::Point& p) {
      return cv::norm(p - expected) <= 2;
    })) << expected;
  EXPECT_TRUE(std::is_sorted(corners.begin(), corners.end(),
                             [](const cv::Point& a, const cv::Point& b) { return a.y < b.y; }));
}

TEST(Corners, AreTheMaximaOfTheHarrisResponse) {
  const cv::Mat image = fadingTexture(320, 240);
  for (const double k : {0.04, 0.15}) {
    // OpenCV's response; every maximum of at least a twentieth of the largest, in order of rows.
    cv::Mat response;
    cv::cornerHarris(image, response, 3, 3, k);
    double strongest = 0;
    cv::minMaxLoc(response, nullptr, &strongest);
    cv::Mat neighbourhood;
    cv::dilate(response, neighbourhood, cv::Mat::ones(3, 3, CV_8U));
    std::vector<cv::Point> expected;
    for (int v = 3; v + 3 < image.rows; ++v)
      for (int u = 2; u + 2 < image.cols; ++u)
        if (response.at<float>(v, u) > 0.05 * strongest &&
            response.at<float>(v, u) == neighbourhood.at<float>(v, u))
          expected.emplace_back(u, v);
    ASSERT_GT(expected.size(), 50U);
    EXPECT_EQ(findCorners(image, everywhere(image), {1000000, 0.05, 1, k}), expected) << k;
  }
}

TEST(Corners, SpreadOverTheImageThoughTheTextureIsStrongOnOneSideOnly) {
  const cv::Mat image = fadingTexture(320, 240);
  const std::vector<cv::Point> corners = find(image, everywhere(image), 200);
  EXPECT_EQ(corners.size(), 200U);
  constexpr int kColumns = 8, kRows = 6;
  std::vector<int> counts(kColumns * kRows);
  for (const cv::Point& p : corners) ++counts[p.y * kRows / 240 * kColumns + p.x * kColumns / 320];
  // 4.2 a cell if spread evenly; none is empty, none takes more than three times its share.
  EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 1);
  EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 12);
}

TEST(Corners, KeepTheMinimalDistanceAndTheCount) {
  const cv::Mat image = fadingTexture(200, 150);
  for (const double distance : {1.0, 4.0, 9.5}) {
    const std::vector<cv::Point> corners =
        findCorners(image, everywhere(image), {5000, kQuality, distance, kHarrisK});
    ASSERT_GT(corners.size(), 30U);
    for (size_t i = 0; i < corners.size(); ++i)
      for (size_t j = 0; j < i; ++j) ASSERT_GE(cv::norm(corners[i] - corners[j]), distance);
  }
  EXPECT_EQ(find(image, everywhere(image), 37).size(), 37U);
}

TEST(Corners, StayInsideTheMask) {
  const cv::Mat image = fadingTexture(320, 240);
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  cv::circle(mask, {200, 100}, 60, cv::Scalar(255), cv::FILLED);
  mask(cv::Rect(190, 90, 20, 20)) = 0;
  const std::vector<cv::Point> corners = find(image, mask, 300);
  ASSERT_GT(corners.size(), 50U);
  for (const cv::Point& p : corners) EXPECT_NE(mask.at<uchar>(p), 0) << p;
}

TEST(Corners, AreAtTheSamePlacesWhateverLiesOutsideTheMask) {
  cv::Mat image = fadingTexture(320, 240);
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  mask(cv::Rect(40, 50, 150, 120)) = 255;
  const std::vector<cv::Point> before = find(image, mask, 100);
  // Beyond the reach of gradient and window.
  cv::rectangle(image, cv::Rect(0, 0, 30, 240), cv::Scalar(255), cv::FILLED);
  cv::rectangle(image, cv::Rect(10, 30, 5, 5), cv::Scalar(0), cv::FILLED);
  EXPECT_EQ(before, find(image, mask, 100));
}

TEST(Corners, AreDeterministicAndTheSameInFloat) {
  const cv::Mat image = fadingTexture(320, 240);
  cv::Mat as_float;
  image.convertTo(as_float, CV_32F);
  const std::vector<cv::Point> corners = find(image, everywhere(image), 150);
  EXPECT_EQ(corners, find(image.clone(), everywhere(image), 150));
  const std::vector<cv::Point> from_float = find(as_float, everywhere(image), 150);
  ASSERT_EQ(corners.size(), from_float.size());
  const auto less = [](const cv::Point& a, const cv::Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
  std::vector<cv::Point> common;
  std::set_intersection(corners.begin(), corners.end(), from_float.begin(), from_float.end(),
                        std::back_inserter(common), less);
  EXPECT_GT(common.size(), 140U);
}

TEST(Corners, AreNoneWhereThereIsNothingToSee) {
  for (const int grey : {0, 128, 255}) {
    const cv::Mat image(100, 120, CV_8UC1, cv::Scalar(grey));
    EXPECT_TRUE(find(image, everywhere(image), 100).empty()) << grey;
  }
  const cv::Mat image = fadingTexture(120, 100);
  EXPECT_TRUE(find(image, cv::Mat::zeros(image.size(), CV_8UC1), 100).empty());
  cv::Mat dot = cv::Mat::zeros(image.size(), CV_8UC1);
  dot.at<uchar>(50, 60) = 255;
  EXPECT_LE(find(image, dot, 100).size(), 1U);
}

TEST(Corners, AreNotFoundAlongAStraightEdge) {
  cv::Mat image(100, 120, CV_8UC1, cv::Scalar(40));
  image.colRange(60, 120) = 200;
  cv::Mat inner = cv::Mat::zeros(image.size(), CV_8UC1);
  inner(cv::Rect(10, 10, 100, 80)) = 255;
  EXPECT_TRUE(find(image, inner, 100).empty());
}

TEST(CornerBudget, IsWhatAnImageHasRoomFor) {
  EXPECT_EQ(cornerBudget({640, 480}, 500, 300), 500);
  EXPECT_EQ(cornerBudget({320, 240}, 500, 300), 256);
  EXPECT_EQ(cornerBudget({320, 240}, 200, 300), 200);
  EXPECT_EQ(cornerBudget({320, 240}, 500, 1), 500);
}

TEST(CornerBudget, IsNeverNothing) {
  EXPECT_EQ(cornerBudget({64, 48}, 500, 10000), 20);
  EXPECT_EQ(cornerBudget({64, 48}, 10, 10000), 10);
}

}  // namespace
}  // namespace uav_landing
