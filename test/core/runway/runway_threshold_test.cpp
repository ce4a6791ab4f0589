#include "runway/threshold/runway_threshold.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::Pose;

/// Bars across y = +-1 m from x = 6 m on, drawn by hand so that they are symmetric, with a line before them.
struct Bars {
  StereoRig rig = test::makeRig(640, 480, 0.65);
  RigModel model = test::makeModel(rig);
  Pose pose;
  double line_from = 5.6, line_to = 5.7;
  double pavement_from = 6;  // m; as bright as what lies before it when it is the same
  uchar pavement = 70, before = 70, line = 200;
  bool sparse = false;
  bool aiming_point = false;  // instead of the bars: its two marks, the centre line and the edge lines

  Bars() {
    pose.position = {1.5, 0.1, 1.5};
    pose.pitch = -8 * kDegree;
    pose.roll = 2 * kDegree;
    pose.yaw = 3 * kDegree;
  }
  void fill(cv::Mat& image, double x0, double x1, double y0, double y1, uchar grey = 200) const {
    constexpr double kScale = 16;
    std::vector<cv::Point> corners;
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}) {
      const Eigen::Vector2d pixel = rig.project(pose.seen(Eigen::Vector3d(x, y, 0) - pose.position));
      corners.emplace_back(cvRound(pixel.x() * kScale), cvRound(pixel.y() * kScale));
    }
    cv::fillConvexPoly(image, corners, grey, cv::LINE_AA, 4);
  }
  Expected<Threshold> find() const {
    cv::Mat image(rig.size, CV_8U, cv::Scalar(before));
    if (pavement != before) fill(image, pavement_from, 30, -1.2, 1.2, pavement);
    if (line_to > line_from) fill(image, line_from, line_to, -1, 1, line);
    if (aiming_point) {
      for (const double y : {-0.52, 0.52}) fill(image, 6, 7.5, y - 0.12, y + 0.12);
      for (const double y : {-0.9, 0.9}) fill(image, 2, 30, y - 0.06, y + 0.06);
      fill(image, 2, 30, -0.025, 0.025);
    }
    for (double y = 0.08; !aiming_point && y < 0.95; y += 0.16) {
      if (sparse && y < 0.6) continue;
      fill(image, 6, 7.5, y, y + 0.08);
      fill(image, 6, 7.5, -y - 0.08, -y);
    }
    const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * std::pow(0.02 * kDegree, 2);
    const GroundAxes axes(pose.down(), covariance, pose.seen(Eigen::Vector3d::UnitX()), covariance);
    const double h = pose.height();
    std::vector<LineGreys> memory;
    return findThreshold({image, model.left_mask}, rig, axes, {-0.1 / h, 1e-6, 2 / h, 1e-6}, memory);
  }
};

TEST(RunwayThreshold, IsTheNearEdgeOfTheLineBeforeTheBars) {
  const Bars bars;
  const auto found = bars.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->distance * 1.5, 5.6 - 1.5, 0.04);
  EXPECT_LT(std::abs(found->distance * 1.5 - (5.6 - 1.5)), 3 * 1.5 * std::sqrt(found->variance));
}

TEST(RunwayThreshold, ClaimsNeitherItsStandardPlaceNorTheBarsWhenOnlyTheyAreSeen) {
  Bars bars;
  bars.line_to = bars.line_from;
  const auto found = bars.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_GT(found->systematic_variance, 0);
  EXPECT_LT(found->systematic_variance, found->variance);
  // Bars of the standard are 3.5 m apart and begin 6 m behind the threshold; these are 0.16 m apart.
  const double stddev = 1.5 * std::sqrt(found->variance), distance = found->distance * 1.5;
  for (const double offset : {0.0, 0.06, 6 / 3.5 * 0.16})
    EXPECT_LT(std::abs(distance - (6 - offset - 1.5)), 1.2 * stddev) << offset;
  EXPECT_LT(stddev, 0.2);
}

TEST(RunwayThreshold, IsWhereThePavementBeginsWhenThereIsNoLine) {
  for (const int before : {40, 55, 90}) {
    Bars bars;
    bars.line_to = bars.line_from;
    bars.before = static_cast<uchar>(before);
    bars.pavement_from = 5.75;
    const auto found = bars.find();
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_NEAR(found->distance * 1.5, 5.75 - 1.5, 0.03) << before;
    EXPECT_EQ(found->systematic_variance, 0);
  }
}

TEST(RunwayThreshold, IsTheNearEdgeOfALineThatBrightGroundHides) {
  // Lines of 1.2 and 3 m on a runway of the standard.
  for (const double width : {0.055, 0.137})
    for (const int before : {130, 150, 160}) {
      Bars bars;
      bars.line = 165;
      bars.before = static_cast<uchar>(before);
      bars.line_from = bars.pavement_from = 6 - 6 / 3.5 * 0.16;
      bars.line_to = bars.line_from + width;
      const auto found = bars.find();
      ASSERT_TRUE(found) << found.error().message();
      EXPECT_LT(std::abs(found->distance * 1.5 - (bars.line_from - 1.5)),
                2.5 * 1.5 * std::sqrt(found->variance))
          << width << " " << before;
      // The far edge of the wide one is next to the bars: nothing but these is seen.
      const bool told = width < 0.1 && before < 160;
      EXPECT_TRUE(found->systematic_variance == 0 || !told) << width << " " << before;
    }
}

TEST(RunwayThreshold, BrightGroundMayHideALine) {
  Bars bars;
  bars.line_to = bars.line_from;
  bars.before = 150;
  bars.pavement_from = 5.75;
  const auto found = bars.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_GT(found->systematic_variance, 0);
}

TEST(RunwayThreshold, IsWhereThePavementBeginsBehindAStripThatIsNoPaint) {
  Bars bars;
  bars.pavement = 60;
  bars.before = 100;
  bars.line = 115;
  bars.line_from = 5.69;
  bars.line_to = bars.pavement_from = 5.75;
  const auto found = bars.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->distance * 1.5, 5.75 - 1.5, 0.03);
  EXPECT_EQ(found->systematic_variance, 0);
}

TEST(RunwayThreshold, PavementThatBeginsFarBeforeTheBarsIsNotItsPlace) {
  Bars bars;
  bars.line_to = bars.line_from;
  bars.before = 40;
  bars.pavement_from = 5.2;
  const auto found = bars.find();
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_GT(found->systematic_variance, 0);
}

TEST(RunwayThreshold, MarksOfTheTouchdownZoneAreNoThreshold) {
  Bars bars;
  bars.sparse = true;
  EXPECT_EQ(bars.find().error().reason, Reason::kNoRunway);
}

TEST(RunwayThreshold, TheAimingPointIsNone) {
  Bars bars;
  bars.aiming_point = true;
  for (const double line : {0.0, 0.1}) {
    bars.line_to = bars.line_from + line;
    EXPECT_FALSE(bars.find()) << line;
  }
}

TEST(RunwayThreshold, IsNotToldWhenWhatLiesBeforeTheBarsIsOutOfThePicture) {
  Bars bars;
  bars.pose.position.x() = 3.6;
  EXPECT_FALSE(bars.find());
}

TEST(RunwayThreshold, TextureIsNone) {
  const Bars bars;
  GroundRenderer grass(5);
  grass.contrast = 25;
  grass.grain = 0.05;
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * 1e-8;
  const GroundAxes axes(bars.pose.down(), covariance, bars.pose.seen(Eigen::Vector3d::UnitX()), covariance);
  std::vector<LineGreys> memory;
  EXPECT_FALSE(findThreshold({grass.left(bars.rig, bars.pose), bars.model.left_mask}, bars.rig, axes,
                             {0, 1e-6, 2 / 1.5, 1e-6}, memory));
}

TEST(RunwayThreshold, ARunwayBesideTheCameraIsOutsideThePicture) {
  // The camera looks across the runway and stands a hair behind one of the places where it is sampled.
  const Bars bars;
  const cv::Mat image(bars.rig.size, CV_8U, cv::Scalar(70));
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * 1e-8;
  const GroundAxes axes(Eigen::Vector3d::UnitY(), covariance, Eigen::Vector3d::UnitX(), covariance);
  const double step = 0.92 * 2 / 96;
  std::vector<LineGreys> memory;
  EXPECT_FALSE(findThreshold({image, bars.model.left_mask}, bars.rig, axes,
                             {0.5 * step + 1e-9, 1e-6, 2, 1e-6}, memory));
}

}  // namespace
}  // namespace uav_landing
