#include "lines/segments/line_segments.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace uav_landing {
namespace {

const cv::Size kSize(640, 480);
constexpr int kSamples = 16;  // per pixel and axis

using Polygon = std::vector<cv::Point2d>;

/// Convex polygons on a dark ground, each pixel the mean over its square: pixel (u, v) is the square around
/// that point. Blurred a little as a lens does, with noise of this many grey levels.
cv::Mat render(const std::vector<Polygon>& polygons, double noise = 0, double blur = 0) {
  cv::Mat image(kSize, CV_32F, cv::Scalar(70));
  for (const Polygon& polygon : polygons) {
    const auto inside = [&](double x, double y) {
      for (size_t i = 0; i < polygon.size(); ++i) {
        const cv::Point2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) < 0) return false;
      }
      return true;
    };
    for (int v = 0; v < kSize.height; ++v)
      for (int u = 0; u < kSize.width; ++u) {
        int count = 0, corners = 0;
        for (const double dy : {-0.5, 0.5})
          for (const double dx : {-0.5, 0.5}) corners += inside(u + dx, v + dy);
        if (corners == 0 && polygon.size() == 4 && !inside(u, v)) continue;
        if (corners == 4) {
          count = kSamples * kSamples;
        } else {
          for (int i = 0; i < kSamples * kSamples; ++i)
            count +=
                inside(u - 0.5 + (i % kSamples + 0.5) / kSamples, v - 0.5 + (i / kSamples + 0.5) / kSamples);
        }
        const float share = static_cast<float>(count) / (kSamples * kSamples);
        float& grey = image.at<float>(v, u);
        grey += share * (190 - grey);
      }
  }
  if (blur > 0) cv::GaussianBlur(image, image, {}, blur);
  if (noise > 0) {
    cv::Mat added(kSize, CV_32F);
    cv::RNG random(5);
    random.fill(added, cv::RNG::NORMAL, 0, noise);
    image += added;
  }
  cv::Mat grey;
  image.convertTo(grey, CV_8U);
  return grey;
}

/// A runway from the threshold up to near the vanishing point (322, 95), and a centre line 4 px wide.
std::vector<Polygon> runway() { return {{{301.3, 140.2}, {348.8, 140.2}, {548.4, 455.6}, {103.7, 455.6}}}; }

cv::Mat allGround() {
  cv::Mat ground = cv::Mat::zeros(kSize, CV_8UC1);
  ground(cv::Rect(6, 100, 628, 374)) = 255;
  return ground;
}

double distance(const LineSegment& line, const cv::Point2d& p) {
  return std::abs(line.line.dot(Eigen::Vector3d(p.x, p.y, 1)));
}

/// The found line nearest to the edge from a to b: largest distance of the edge's ends from it.
const LineSegment* nearest(const std::vector<LineSegment>& lines, const cv::Point2d& a,
                           const cv::Point2d& b) {
  const auto miss = [&](const LineSegment& line) { return std::max(distance(line, a), distance(line, b)); };
  const auto best =
      std::min_element(lines.begin(), lines.end(),
                       [&](const LineSegment& l, const LineSegment& r) { return miss(l) < miss(r); });
  return best == lines.end() ? nullptr : &*best;
}

void expectEdges(const std::vector<LineSegment>& lines, const Polygon& polygon, double tolerance) {
  for (size_t i = 0; i < polygon.size(); ++i) {
    const cv::Point2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const LineSegment* line = nearest(lines, a, b);
    ASSERT_NE(line, nullptr);
    EXPECT_LT(distance(*line, a), tolerance) << "edge " << i;
    EXPECT_LT(distance(*line, b), tolerance) << "edge " << i;
    EXPECT_GT(line->length(), 0.85 * cv::norm(b - a)) << "edge " << i;
  }
}

TEST(FindLines, AreWithinATwentiethOfAPixel) {
  const auto polygons = runway();
  expectEdges(findLines({render(polygons), allGround()}, {}), polygons[0], 0.05);
}

TEST(FindLines, AreWithinATwentiethOfAPixelWithNoiseAndBlur) {
  const auto polygons = runway();
  const std::vector<LineSegment> lines = findLines({render(polygons, 2, 0.8), allGround()}, {});
  expectEdges(lines, polygons[0], 0.05);
  EXPECT_EQ(lines.size(), 4U);
}

TEST(FindLines, AreAccurateAtAnyAngleAndPlace) {
  for (double angle = 0.02; angle < M_PI; angle += 0.31) {
    const cv::Point2d centre(320.37 + 10 * angle, 280.81), along(std::cos(angle), std::sin(angle)),
        across(-along.y, along.x);
    const Polygon bar{centre - 120 * along - 20 * across, centre + 120 * along - 20 * across,
                      centre + 120 * along + 20 * across, centre - 120 * along + 20 * across};
    const std::vector<LineSegment> lines = findLines({render({bar}, 1), allGround()}, {});
    for (const int side : {0, 2}) {
      const LineSegment* line = nearest(lines, bar[side], bar[side + 1]);
      ASSERT_NE(line, nullptr);
      EXPECT_LT(distance(*line, bar[side]), 0.05) << angle;
      EXPECT_LT(distance(*line, bar[side + 1]), 0.05) << angle;
    }
  }
}

TEST(FindLines, HoughTransformsFindTheSameEdges) {
  for (const HoughMethod method : {HoughMethod::kProbabilistic, HoughMethod::kStandard}) {
    ApproachAngleParameters parameters;
    parameters.hough_method = method;
    const auto polygons = runway();
    const std::vector<LineSegment> lines = findLines({render(polygons, 2, 0.8), allGround()}, parameters);
    expectEdges(lines, polygons[0], 0.05);
    EXPECT_EQ(lines.size(), 4U);
  }
}

TEST(FindLines, StandardHoughCutsALineWhereTheEdgeEnds) {
  ApproachAngleParameters parameters;
  parameters.hough_method = HoughMethod::kStandard;
  const std::vector<Polygon> dashes{{{300.3, 150}, {312.3, 150}, {312.3, 250}, {300.3, 250}},
                                    {{300.3, 300}, {312.3, 300}, {312.3, 400}, {300.3, 400}}};
  const std::vector<LineSegment> lines = findLines({render(dashes, 1), allGround()}, parameters);
  int upright = 0;
  for (const LineSegment& line : lines) {
    if (std::abs(line.b.x() - line.a.x()) > 5) continue;
    ++upright;
    EXPECT_NEAR(line.length(), 100, 8);
  }
  EXPECT_EQ(upright, 4);
}

TEST(FindLines, BothEdgesOfAThinStripeAreFoundApart) {
  const std::vector<Polygon> stripe{{{310.2, 150.1}, {312.3, 150.1}, {263.3, 440.2}, {261.1, 440.2}}};
  const std::vector<LineSegment> lines = findLines({render(stripe, 1), allGround()}, {});
  const LineSegment* left = nearest(lines, stripe[0][0], stripe[0][3]);
  const LineSegment* right = nearest(lines, stripe[0][1], stripe[0][2]);
  ASSERT_NE(left, nullptr);
  EXPECT_NE(left, right);
  // A stripe as thin as the gradient operator pushes its edges apart by some hundredths of a pixel.
  EXPECT_LT(distance(*left, stripe[0][3]), 0.15);
  EXPECT_LT(distance(*right, stripe[0][2]), 0.15);
  // The normals point to the bright inside.
  EXPECT_GT(left->line.x(), 0.9);
  EXPECT_LT(right->line.x(), -0.9);
}

// Long and short ones in turn, as both may be found first, and both sides of each, which run opposite ways.
TEST(FindLines, PiecesOfOneEdgeThatAreFarApartAreLinesOfTheirOwn) {
  const std::vector<cv::Rect> bars = {{200, 105, 12, 55}, {200, 200, 12, 130}, {200, 375, 12, 70}};
  cv::Mat image(kSize, CV_8U, cv::Scalar(70));
  for (const cv::Rect& bar : bars) image(bar).setTo(190);
  const std::vector<LineSegment> lines = findLines({image, allGround()}, {});
  for (const cv::Rect& bar : bars)
    for (const double u : {bar.x - 0.5, bar.x + bar.width - 0.5}) {
      int count = 0;
      for (const LineSegment& line : lines) {
        const Eigen::Vector2d middle = line.middle();
        count += std::abs(middle.x() - u) < 1 && std::abs(middle.y() - bar.y - bar.height / 2.0) < 3 &&
                 line.length() > 0.85 * bar.height;
      }
      EXPECT_EQ(count, 1) << bar << " at " << u;
    }
}

TEST(FindLines, DescribeThemselvesConsistently) {
  for (const LineSegment& line : findLines({render(runway(), 2, 0.8), allGround()}, {})) {
    EXPECT_NEAR(line.line.head<2>().norm(), 1, 1e-12);
    EXPECT_NEAR(distance(line, {line.a.x(), line.a.y()}), 0, 1e-9);
    EXPECT_NEAR(distance(line, {line.b.x(), line.b.y()}), 0, 1e-9);
    EXPECT_GT(line.offset_stddev, 0);
    EXPECT_LT(line.offset_stddev, 0.1);
    EXPECT_GT(line.angle_stddev, 0.05 / line.length());
    EXPECT_LT(line.angle_stddev, 0.5 / line.length());
  }
}

TEST(FindLines, AdmitTheErrorThatNoiseMakes) {
  // Heavy noise on short bars; the errors in units of the stated deviations must be of order one.
  double squares = 0;
  int count = 0;
  for (int k = 0; k < 6; ++k) {
    std::vector<Polygon> bars;
    for (int i = 0; i < 8; ++i) {
      const double x = 40.2 + 70 * i + 3.1 * k, lean = 6 * i - 25 + k;
      bars.push_back({{x, 200.3}, {x + 25, 200.3}, {x + 25 + lean, 260.4}, {x + lean, 260.4}});
    }
    const std::vector<LineSegment> lines = findLines({render(bars, 12, 0.7), allGround()}, {});
    for (const Polygon& bar : bars) {
      const LineSegment* line = nearest(lines, bar[3], bar[0]);
      ASSERT_NE(line, nullptr);
      if (std::max(distance(*line, bar[0]), distance(*line, bar[3])) > 2) continue;  // not found
      const Eigen::Vector2d m = line->middle();
      const double t = (m.y() - bar[0].y) / (bar[3].y - bar[0].y);
      squares += std::pow(distance(*line, bar[0] + t * (bar[3] - bar[0])) / line->offset_stddev, 2);
      ++count;
    }
  }
  ASSERT_GT(count, 30);
  EXPECT_LT(squares / count, 2.0);
  EXPECT_GT(squares / count, 0.2);
}

TEST(FindLines, AreOnTheGroundOnly) {
  cv::Mat ground = cv::Mat::zeros(kSize, CV_8UC1);
  ground(cv::Rect(0, 300, 640, 180)) = 255;
  const std::vector<LineSegment> lines = findLines({render(runway(), 2, 0.8), ground}, {});
  ASSERT_GE(lines.size(), 2U);
  for (const LineSegment& line : lines) EXPECT_GT(std::min(line.a.y(), line.b.y()), 299);
  EXPECT_TRUE(findLines({render(runway()), cv::Mat::zeros(kSize, CV_8UC1)}, {}).empty());
}

TEST(FindLines, WithoutRefinementAreAsGoodAsTheirHoughCell) {
  ApproachAngleParameters parameters;
  parameters.refine_lines = false;
  const auto polygons = runway();
  const std::vector<LineSegment> lines = findLines({render(polygons, 2, 0.8), allGround()}, parameters);
  for (const auto& [a, b] : {std::pair{polygons[0][1], polygons[0][2]}, {polygons[0][3], polygons[0][0]}}) {
    const LineSegment* line = nearest(lines, a, b);
    ASSERT_NE(line, nullptr);
    EXPECT_LT(distance(*line, 0.5 * (a + b)), 2);
    EXPECT_GE(line->offset_stddev, 0.3);
  }
}

TEST(FindLines, HaveNothingToSayOnAUniformImage) {
  for (const int grey : {0, 128, 255})
    EXPECT_TRUE(findLines({cv::Mat(kSize, CV_8UC1, cv::Scalar(grey)), allGround()}, {}).empty());
}

TEST(FindLines, AreTheSameEachTime) {
  const cv::Mat image = render(runway(), 4, 0.8);
  const std::vector<LineSegment> first = findLines({image, allGround()}, {});
  const std::vector<LineSegment> second = findLines({image.clone(), allGround()}, {});
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].line, second[i].line);
    EXPECT_EQ(first[i].a, second[i].a);
    EXPECT_EQ(first[i].angle_stddev, second[i].angle_stddev);
  }
}

TEST(FindLines, LookAtTheWholeOfATinyOrEmptyImageWithoutHarm) {
  EXPECT_TRUE(findLines({cv::Mat::zeros(4, 4, CV_8UC1), cv::Mat::ones(4, 4, CV_8UC1)}, {}).empty());
  const cv::Mat noise(40, 40, CV_8UC1);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  findLines({noise, cv::Mat(40, 40, CV_8UC1, cv::Scalar(255))}, {});
}

/// A view whose horizon is the row of runway()'s vanishing point.
HeadingGate runwayGate() {
  Eigen::Matrix3d K;
  K << 500, 0, 322, 0, 500, 95, 0, 0, 1;
  return {K, Eigen::Vector3d::UnitY(), 30 * M_PI / 180};
}

/// With its brighter side, the inside: to the right of the way from a to b.
RoughSegment edgeOf(const cv::Point2d& a, const cv::Point2d& b) {
  return {{a.x, a.y}, {b.x, b.y}, {a.y - b.y, b.x - a.x}};
}

TEST(FindLines, RefineOnlyThoseThatMayBeAlongTheRunwayIfToldSo) {
  const auto polygons = runway();
  const HeadingGate gate = runwayGate();
  const std::vector<LineSegment> lines = findLines({render(polygons, 2, 0.8), allGround()}, {}, &gate);
  ASSERT_EQ(lines.size(), 4U);
  expectEdges(lines, polygons[0], 1.5);
  const Polygon& corners = polygons[0];
  for (const int side : {1, 3}) {
    const cv::Point2d &a = corners[side], &b = corners[(side + 1) % 4];
    const LineSegment* line = nearest(lines, a, b);
    EXPECT_LT(std::max(distance(*line, a), distance(*line, b)), 0.05);
    EXPECT_LT(line->offset_stddev, 0.1);
  }
  for (const int side : {0, 2})
    EXPECT_GE(nearest(lines, corners[side], corners[(side + 1) % 4])->offset_stddev, 0.5);
}

TEST(FindLines, LinesAcrossLeaveRoomForThoseAlongTheRunway) {
  // 300 edges of 60 px across, and a stripe of 40 px from the vanishing point (322, 95) on.
  cv::Mat image(kSize, CV_8U, cv::Scalar(70));
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 30; ++row) {
      const cv::Rect bar(10 + 80 * column + (column > 1 ? 210 : 0), 110 + 12 * row, 60, 6);
      image(bar & cv::Rect({}, kSize)).setTo(190);
    }
  const cv::Point2d a(322 + 0.1 * 200, 295), b(322 + 0.1 * 240, 335);
  const std::vector<cv::Point> stripe{a, b, cv::Point2d(b.x + 9, b.y), cv::Point2d(a.x + 7, a.y)};
  cv::fillConvexPoly(image, stripe, cv::Scalar(190));
  const HeadingGate gate = runwayGate();
  const auto found = [&](const HeadingGate* used) {
    const std::vector<LineSegment> lines = findLines({image, allGround()}, {}, used);
    const LineSegment* line = nearest(lines, a, b);
    return line != nullptr && std::max(distance(*line, a), distance(*line, b)) < 1.5;
  };
  EXPECT_FALSE(found(nullptr)) << "there are longer ones";
  EXPECT_TRUE(found(&gate));
}

TEST(FindLinesNear, AreThoseOfTheExpectedOnesThatAreThere) {
  const Polygon corners = runway()[0];
  const cv::Mat image = render({corners}, 2, 0.8);
  RoughSegment right = edgeOf(corners[1] + cv::Point2d(1.9, 0), corners[2] + cv::Point2d(1.2, 0));
  // As far beyond the image's lower side as it is long.
  right.b += right.b - right.a;
  const RoughSegment left = edgeOf(corners[3] - cv::Point2d(1.3, 0.8), corners[0] - cv::Point2d(1.3, 0.8));
  const RoughSegment nowhere = edgeOf({100, 150}, {130, 300}), outside = edgeOf({-90, 150}, {-30, 300});
  RoughSegment darker = right;
  darker.brighter = -darker.brighter;
  LineMemory memory;
  const auto find = [&](const std::vector<RoughSegment>& expected) {
    return findLinesNear({image, allGround()}, expected, {}, runwayGate(), memory);
  };
  EXPECT_TRUE(find({nowhere, outside, darker}).empty());
  const std::vector<LineSegment> lines = find({nowhere, right, outside, left});
  ASSERT_EQ(lines.size(), 2U);
  for (const int side : {1, 3}) {
    const cv::Point2d &a = corners[side], &b = corners[(side + 1) % 4];
    const LineSegment* line = nearest(lines, a, b);
    EXPECT_LT(std::max(distance(*line, a), distance(*line, b)), 0.05);
    EXPECT_GT(line->length(), 0.85 * cv::norm(b - a));
    EXPECT_GT(line->line.dot(Eigen::Vector3d(322, 300, 1)), 0) << "brighter inside";
  }
  EXPECT_TRUE(findLinesNear({image, cv::Mat::zeros(kSize, CV_8UC1)}, {right, left}, {}, runwayGate(), memory)
                  .empty());
}

TEST(FindLinesNear, AreAsFindLinesHasThemButForThoseAcross) {
  const cv::Mat image = render(runway(), 2, 0.8);
  const HeadingGate gate = runwayGate();
  const std::vector<LineSegment> found = findLines({image, allGround()}, {}, &gate);
  std::vector<RoughSegment> expected;
  for (const LineSegment& line : found) expected.push_back({line.a, line.b, line.line.head<2>()});
  LineMemory memory;
  const std::vector<LineSegment> again = findLinesNear({image, allGround()}, expected, {}, gate, memory);
  ASSERT_EQ(found.size(), 4U);
  ASSERT_EQ(again.size(), 2U);
  for (size_t i = 0; i < again.size(); ++i) {
    EXPECT_LT(std::abs(found[i].line.dot(again[i].middle().homogeneous())), 0.02);
    EXPECT_NEAR(again[i].offset_stddev, found[i].offset_stddev, 0.2 * found[i].offset_stddev);
    EXPECT_NEAR(again[i].length(), found[i].length(), 3);
  }
}

}  // namespace
}  // namespace uav_landing
