#include "simulator/approach/own_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "uav_landing/simulator/approach_simulator.h"

namespace uav_landing {
namespace {

SimulatedImageParameters picture() {
  SimulatedImageParameters image;
  image.width = 200;
  image.height = 100;
  return image;
}

cv::Mat drawn(const SimulatedOwnFrameParameters& p, OwnFrame::Side camera) {
  cv::Mat grey(100, 200, CV_32F, cv::Scalar(150));
  OwnFrame(p, picture(), camera).draw(grey);
  return grey;
}

/// Rows of the column's lower end that are covered; what is covered is darker than 100.
double coveredRows(const cv::Mat& grey, int column) {
  double rows = 0;
  for (int row = 0; row < grey.rows; ++row) {
    const double bottom = grey.at<float>(99, column);
    rows += (150 - grey.at<float>(row, column)) / (150 - bottom);
  }
  return rows;
}

TEST(OwnFrame, IsNotThereByDefault) {
  EXPECT_EQ(cv::norm(drawn({}, OwnFrame::Side::kLeft) - 150.0f, cv::NORM_INF), 0);
}

TEST(OwnFrame, TheNoseIsAParabolaOfItsHeightAndWidthInEachPicture) {
  SimulatedOwnFrameParameters p;
  p.nose_height = 0.4;  // 40 rows
  p.nose_width = 0.5;   // 100 columns
  p.nose_left = 0.6;    // around the 120th
  p.nose_right = 0.3;   // around the 60th
  p.nose_brightness = 40;
  for (const auto& [camera, middle] : {std::pair{OwnFrame::Side::kLeft, 120}, {OwnFrame::Side::kRight, 60}}) {
    const cv::Mat grey = drawn(p, camera);
    for (const int away : {-40, -25, 0, 25, 40}) {
      // The pixel's middle is half a pixel off the boundary between two columns.
      const double at = (away + 0.5) / 50;
      EXPECT_NEAR(coveredRows(grey, middle + away), 40 * (1 - at * at), 0.3) << away;
    }
    EXPECT_EQ(grey.at<float>(99, middle - 53), 150);
    EXPECT_EQ(grey.at<float>(99, middle + 53), 150);
  }
}

TEST(OwnFrame, ThePostIsAsThickAsAskedAndLeansTheOtherWayOnTheOtherSide) {
  SimulatedOwnFrameParameters p;
  p.post_width = 0.05;  // 10 columns across it
  p.post_left = 0.2;
  p.post_right = 0.8;
  p.post_tilt_deg = 20;
  p.post_brightness = 30;
  for (const auto& [camera, middle, sign] :
       {std::tuple{OwnFrame::Side::kLeft, 40.0, 1}, {OwnFrame::Side::kRight, 160.0, -1}}) {
    const cv::Mat grey = drawn(p, camera);
    for (const int row : {10, 50, 90}) {
      double thickness = 0, moment = 0;
      for (int column = 0; column < 200; ++column) {
        const double share = (150 - grey.at<float>(row, column)) / 120;
        thickness += share;
        moment += share * (column + 0.5);
      }
      EXPECT_NEAR(thickness, 10 / std::cos(20 * M_PI / 180), 0.15) << row;
      EXPECT_NEAR(moment / thickness, middle + sign * std::tan(20 * M_PI / 180) * (50 - (row + 0.5)), 0.05);
    }
  }
}

TEST(OwnFrame, StaysInPlaceWhileTheAircraftMoves) {
  SimulatorParameters p;
  p.setPictures(160, 120, 138);
  p.image.noise = 0;
  p.image.blur = 0;
  p.path.duration = 2;
  p.path.rate = 1;
  p.wobble.roll_deg = 10;
  const auto plain = ApproachSimulator::create(p);
  p.scenery.own_frame.nose_height = 0.3;
  const auto simulator = ApproachSimulator::create(p);
  ASSERT_TRUE(simulator && plain);
  const ApproachSimulator::Frame first = simulator->frame(0), last = simulator->frame(2);
  const cv::Rect left(90, 110, 12, 10), right(58, 110, 12, 10);  // around 0.6 and 0.4 of the width
  EXPECT_EQ(cv::norm(first.left(left), last.left(left), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(first.right(right), last.right(right), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(first.left(left), first.right(right), cv::NORM_INF), 0)
      << "each camera at its own place";
  const cv::Rect above(0, 0, 160, 80);
  EXPECT_EQ(cv::norm(first.left(above), plain->frame(0).left(above), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace uav_landing
