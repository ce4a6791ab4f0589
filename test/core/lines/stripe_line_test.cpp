#include "lines/segments/stripe_line.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lines/segments/line_segments.h"

namespace uav_landing {
namespace {

const cv::Size kSize(400, 300);
const Eigen::Vector3d kVanishing(210.3, 20.6, 1);

/// Stripes on the ground seen in perspective, exact shares of pixels, then the lens's blur. A stripe's sides
/// meet in the vanishing point and cut the bottom row at two columns.
struct Stripe {
  double from, to;  // columns in the bottom row
  double brighter = 120;
};

cv::Mat picture(const std::vector<Stripe>& stripes, double blur) {
  cv::Mat image(kSize, CV_32FC1, cv::Scalar(80));
  const double bottom = kSize.height - 1 - kVanishing.y();
  for (int v = 60; v < kSize.height; ++v) {
    const double share = (v - kVanishing.y()) / bottom;
    for (const Stripe& stripe : stripes) {
      const double from = kVanishing.x() + share * (stripe.from - kVanishing.x());
      const double to = kVanishing.x() + share * (stripe.to - kVanishing.x());
      for (int u = 0; u < kSize.width; ++u) {
        const double covered = std::min(u + 0.5, to) - std::max(u - 0.5, from);
        if (covered > 0)
          image.at<float>(v, u) += static_cast<float>(stripe.brighter * std::min(covered, 1.0));
      }
    }
  }
  cv::GaussianBlur(image, image, {}, blur);
  cv::Mat grey;
  image.convertTo(grey, CV_8U);
  return grey;
}

cv::Mat ground() {
  cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC1);
  mask(cv::Rect(15, 65, kSize.width - 30, kSize.height - 75)) = 255;
  return mask;
}

/// Distances by which lines pass the vanishing point, positive when that is on the brighter side.
std::vector<double> misses(const std::vector<LineSegment>& lines) {
  std::vector<double> result;
  for (const LineSegment& line : lines) result.push_back(line.line.dot(kVanishing));
  return result;
}

TEST(StripeLine, SidesThatBlurPushesApartAreReplacedByALineThroughTheVanishingPoint) {
  const cv::Mat image = picture({{60, 64}, {330, 334}}, 0.8);  // 0.6 px wide at the top, 4 at the bottom
  const std::vector<LineSegment> lines = findLines({image, ground()}, {});
  ASSERT_EQ(lines.size(), 4U);
  for (const double miss : misses(lines)) EXPECT_GT(miss, 0.3);
  const std::vector<LineSegment> mended = withoutStripeBias(image, ground(), lines);
  ASSERT_EQ(mended.size(), lines.size());
  for (size_t i = 0; i < mended.size(); ++i) {
    EXPECT_LT(std::abs(misses(mended)[i]), 0.08);
    EXPECT_GT(mended[i].length(), 0.8 * lines[i].length());
    // As its edge was: the same way round, not another stripe's.
    EXPECT_GT(mended[i].line.head<2>().dot(lines[i].line.head<2>()), 0.99);
    EXPECT_LT(std::abs(lines[i].line.dot(mended[i].middle().homogeneous())), 3.0);
  }
}

TEST(StripeLine, BothSidesOfOneStripeTogetherKnowNoMoreThanItsMiddle) {
  const cv::Mat image = picture({{60, 64}}, 0.8);
  const std::vector<LineSegment> both = findLines({image, ground()}, {});
  ASSERT_EQ(both.size(), 2U);
  const double of_both = withoutStripeBias(image, ground(), both)[0].angle_stddev;
  const double alone = withoutStripeBias(image, ground(), {both[0]})[0].angle_stddev;
  EXPECT_NEAR(of_both, std::sqrt(2.0) * alone, 0.02 * alone);
}

TEST(StripeLine, SidesFarApartStayAsTheyAre) {
  const cv::Mat image = picture({{40, 110}}, 0.8);  // 10 px wide at the top
  const std::vector<LineSegment> lines = findLines({image, ground()}, {});
  ASSERT_EQ(lines.size(), 2U);
  for (const double miss : misses(lines)) EXPECT_LT(std::abs(miss), 0.15);
  const std::vector<LineSegment> same = withoutStripeBias(image, ground(), lines);
  for (size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(same[i].line, lines[i].line);
    EXPECT_EQ(same[i].angle_stddev, lines[i].angle_stddev);
  }
}

// A worn part of the paint, a few pixels inside its edge, is eight times fainter than the edge.
TEST(StripeLine, AFaintEdgeBesideALineIsNotItsOtherSide) {
  const cv::Mat image = picture({{40, 110}, {43.7, 75, -15}}, 0.8);
  const std::vector<LineSegment> both = findLines({picture({{40, 110}}, 0.8), ground()}, {});
  ASSERT_EQ(both.size(), 2U);
  const std::vector<LineSegment> same = withoutStripeBias(image, ground(), both);
  for (size_t i = 0; i < both.size(); ++i) {
    EXPECT_EQ(same[i].line, both[i].line);
    EXPECT_EQ(same[i].a, both[i].a);
    EXPECT_EQ(same[i].angle_stddev, both[i].angle_stddev);
  }
}

TEST(StripeLine, AWideStripeThatGetsNarrowKeepsItsVanishingPoint) {
  const cv::Mat image = picture({{60, 80}}, 1.0);  // 3 px wide at the top, 20 at the bottom
  const std::vector<LineSegment> lines = findLines({image, ground()}, {});
  ASSERT_EQ(lines.size(), 2U);
  for (const double miss : misses(withoutStripeBias(image, ground(), lines))) EXPECT_LT(std::abs(miss), 0.15);
}

}  // namespace
}  // namespace uav_landing
