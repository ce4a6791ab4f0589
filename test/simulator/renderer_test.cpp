#include "simulator/approach/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "simulator/lens.h"
#include "uav_landing/geometry/ground_plane.h"
#include "uav_landing/image/rectification.h"

namespace uav_landing {
namespace {

/// A dark board on bright ground, both without texture, seen by a realistic rig.
SimulatorParameters plainBoard() {
  SimulatorParameters p;
  p.image.width = 320;
  p.image.height = 240;
  makeRealistic(p.left_camera, p.right_camera, p.rig);
  p.runway.length = 20;
  p.runway.width = 1.0;
  p.runway.edge_line_width = p.runway.centre_line_width = p.runway.threshold_line_width = 0;
  p.runway.threshold_bars = 0;
  p.runway.aiming_point_length = 0;
  p.runway.tyre_marks = 0;
  p.surface.runway_brightness = 40;
  p.surface.grass_brightness = 200;
  p.surface.runway_contrast = p.surface.grass_contrast = 0;
  p.surface.visibility = 1e6;
  return p;
}

/// Fine texture on the ground, nothing else.
SimulatorParameters texturedGround() {
  SimulatorParameters p = plainBoard();
  p.surface.runway_brightness = p.surface.grass_brightness = 110;
  p.surface.runway_contrast = p.surface.grass_contrast = 0.15;
  p.surface.runway_grain = p.surface.grass_grain = 0.004;
  return p;
}

const CameraPose kPose{{-4.0, 0.1, 1.5}, {2 * kDegree, -14 * kDegree, 1.5 * kDegree}};

struct Pair {
  CameraRig rig;
  cv::Mat left, right;
};
Pair renderPair(const SimulatorParameters& p, const CameraPose& pose) {
  Pair pair{makeCameraRig(p).value(), {}, {}};
  const Renderer renderer(Scene(p.runway, p.surface, 1, Scenery(p.scenery, p.runway, p.surface, 1)),
                          placeObjects(p.objects, p.runway.width, 1), p.image, GroundProfile(p.profile));
  renderer.render(pair.rig.left, pose, pair.left);
  renderer.render(pair.rig.right, pose, pair.right);
  return pair;
}

/// Where a straight mark's edge from one point to another crosses the middle of a row (along = 1) or of a
/// column (along = 0) of the raw image; NaN when it does not.
double crossing(const SimulatorParameters& p, const CameraPose& pose, const Eigen::Matrix3d& R_left,
                bool right, const Eigen::Vector3d& from, const Eigen::Vector3d& to, int along, double line) {
  constexpr int kSteps = 20000;
  Eigen::Vector2d previous = imageOf(p, pose, R_left, right, from);
  for (int i = 1; i <= kSteps; ++i) {
    const Eigen::Vector2d here = imageOf(p, pose, R_left, right, from + (to - from) * i / kSteps);
    if ((previous[along] - line) * (here[along] - line) <= 0) {
      const double share = (line - previous[along]) / (here[along] - previous[along]);
      return previous[1 - along] + share * (here[1 - along] - previous[1 - along]);
    }
    previous = here;
  }
  return std::nan("");
}

/// Position of the one edge between bright and dark in a short profile that starts at this pixel: the amount
/// of bright in it says where the edge is, to a fraction of a pixel.
double edgeInProfile(const std::vector<float>& profile, int start) {
  double bright = 0;
  for (const float grey : profile) bright += (grey - 40.0) / (200.0 - 40.0);
  const bool bright_first = profile.front() > profile.back();
  const double length = static_cast<double>(profile.size());
  return start - 0.5 + (bright_first ? bright : length - bright);
}

std::vector<float> rowProfile(const cv::Mat& image, int row, int start, int length) {
  return cv::Mat(image(cv::Rect(start, row, length, 1))).clone();
}
std::vector<float> columnProfile(const cv::Mat& image, int column, int start, int length) {
  return cv::Mat(image(cv::Rect(column, start, 1, length))).clone();
}

class BoardTest : public testing::TestWithParam<bool> {
 protected:
  const SimulatorParameters parameters_ = plainBoard();
  const Pair pair_ = renderPair(parameters_, kPose);
  const cv::Mat& image_ = GetParam() ? pair_.right : pair_.left;
};

TEST_P(BoardTest, SideEdgesLieWhereLensRigAndAttitudePutThem) {
  int checked = 0;
  for (const double y : {-0.5, 0.5}) {
    for (int row = 80; row < 190; row += 10) {
      const double expected = crossing(parameters_, kPose, pair_.rig.left.calibration.R, GetParam(),
                                       {0.3, y, 0}, {15, y, 0}, 1, row);
      if (!(expected > 10 && expected < 309)) continue;
      const int start = static_cast<int>(std::lround(expected)) - 4;
      EXPECT_NEAR(edgeInProfile(rowProfile(image_, row, start, 9), start), expected, 0.04) << "row " << row;
      ++checked;
    }
  }
  EXPECT_GE(checked, 10);
}

TEST_P(BoardTest, ThresholdLiesWhereLensRigAndAttitudePutIt) {
  int checked = 0;
  for (int column = 10; column < 310; column += 8) {
    const double expected = crossing(parameters_, kPose, pair_.rig.left.calibration.R, GetParam(),
                                     {0, -0.45, 0}, {0, 0.45, 0}, 0, column);
    if (!(expected > 10 && expected < 229)) continue;
    const int start = static_cast<int>(std::lround(expected)) - 4;
    EXPECT_NEAR(edgeInProfile(columnProfile(image_, column, start, 9), start), expected, 0.04)
        << "column " << column;
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

INSTANTIATE_TEST_SUITE_P(Cameras, BoardTest, testing::Values(false, true),
                         [](const auto& info) { return info.param ? "Right" : "Left"; });

TEST(Renderer, EdgesOfTheSceneryLieWhereLensRigAndAttitudePutThem) {
  // A road that is 25 degrees off the runway's direction, and a river across: both dark on bright ground.
  SimulatorParameters p = plainBoard();
  p.runway.width = 0.01;
  p.runway.length = 0.1;
  p.scenery.road.x = 2;
  p.scenery.road.y = 0;
  p.scenery.road.direction_deg = 25;
  p.scenery.road.length = 30;
  p.scenery.road.width = 1;
  p.scenery.road.brightness = 40;
  p.scenery.road.contrast = 0;
  p.scenery.river.x = 9;
  p.scenery.river.direction_deg = -80;
  p.scenery.river.width = 5;
  p.scenery.river.wave = 0;
  p.scenery.river.beach_width = 0;
  p.scenery.river.brightness = 40;
  p.scenery.river.contrast = 0;
  const Pair pair = renderPair(p, kPose);
  const Eigen::Matrix3d& R_left = pair.rig.left.calibration.R;
  const Eigen::Vector3d along(std::cos(25 * kDegree), std::sin(25 * kDegree), 0),
      left(-along.y(), along.x(), 0);
  const Eigen::Vector3d bank(std::cos(80 * kDegree), -std::sin(80 * kDegree), 0);
  for (const bool right : {false, true}) {
    const cv::Mat& image = right ? pair.right : pair.left;
    int road = 0, river = 0;
    for (const double side : {-0.5, 0.5}) {
      const Eigen::Vector3d middle = Eigen::Vector3d(2, 0, 0) + side * left;
      for (int row = 110; row < 220; row += 6) {
        const double expected =
            crossing(p, kPose, R_left, right, middle - 5 * along, middle + 5 * along, 1, row);
        if (!(expected > 10 && expected < 309)) continue;
        const int start = static_cast<int>(std::lround(expected)) - 4;
        EXPECT_NEAR(edgeInProfile(rowProfile(image, row, start, 9), start), expected, 0.06) << "row " << row;
        ++road;
      }
    }
    for (int column = 200; column < 310; column += 8) {
      const Eigen::Vector3d near(9, 0, 0);
      const double expected = crossing(p, kPose, R_left, right, near - 9 * bank, near + 9 * bank, 0, column);
      if (!(expected > 10 && expected < 229)) continue;
      const int start = static_cast<int>(std::lround(expected)) - 2;
      EXPECT_NEAR(edgeInProfile(columnProfile(image, column, start, 5), start), expected, 0.06)
          << "column " << column;
      ++river;
    }
    EXPECT_GE(road, 8);
    EXPECT_GE(river, 6);
  }
}

TEST(Renderer, HorizonIsWhereTheGroundsDirectionsEnd) {
  SimulatorParameters p = plainBoard();
  p.surface.sky_horizon = p.surface.sky_zenith = 100;
  p.surface.cloud_contrast = 0;
  p.runway.width = 0.01;
  p.runway.length = 0.1;
  const Pair pair = renderPair(p, {{0, 0, 5}, {3 * kDegree, -5 * kDegree, 0}});
  // A point 10^7 m away stands for the horizon; the picture is 200 below it and 100 above.
  for (int column = 20; column < 320; column += 40) {
    const Eigen::Vector3d left_end(1e7, 1e7, 0), right_end(1e7, -1e7, 0);
    const double expected = crossing(p, {{0, 0, 5}, {3 * kDegree, -5 * kDegree, 0}},
                                     pair.rig.left.calibration.R, false, left_end, right_end, 0, column);
    const int start = static_cast<int>(std::lround(expected)) - 4;
    double above = 0;
    for (const float grey : columnProfile(pair.left, column, start, 9)) above += (200.0 - grey) / 100.0;
    // The haze of 10^6 m visibility takes a little of the ground next to the horizon.
    EXPECT_NEAR(start - 0.5 + above, expected, 0.06) << "column " << column;
  }
}

/// Columns by which moved lies to the left of image, by least squares: moved = image + shift gradient
/// + gain image + offset. Gain and offset take up what the different footprints of a texture's detail do.
double shiftOf(const cv::Mat& image, const cv::Mat& moved, const cv::Mat& gradient) {
  const int count = static_cast<int>(image.total());
  cv::Mat design(count, 3, CV_32F), solution;
  gradient.clone().reshape(1, count).copyTo(design.col(0));
  image.clone().reshape(1, count).copyTo(design.col(1));
  design.col(2).setTo(1);
  cv::solve(design, cv::Mat(moved - image).reshape(1, count), solution, cv::DECOMP_SVD);
  return solution.at<float>(0);
}

/// Rectified views of the pose, and where in the right one each left pixel's ground is seen if the ground's
/// points have these distances along the rays (x, y, 1).
struct GroundShift {
  cv::Mat left, moved, columns;
};
template <class Range>
GroundShift moveByGround(const Pair& pair, Range&& rangeOf) {
  const StereoRig rig = makeStereoRig(pair.rig.left.calibration, pair.rig.right.calibration).value();
  cv::Mat raw_left, raw_right, left, right;
  pair.left.convertTo(raw_left, CV_8U);
  pair.right.convertTo(raw_right, CV_8U);
  EXPECT_FALSE(Rectifier::create(pair.rig.left.calibration)->rectify(raw_left, left));
  EXPECT_FALSE(Rectifier::create(pair.rig.right.calibration)->rectify(raw_right, right));
  cv::Mat rows(left.size(), CV_32F), shifted;
  GroundShift result;
  result.columns.create(left.size(), CV_32F);
  for (int v = 0; v < left.rows; ++v) {
    for (int u = 0; u < left.cols; ++u) {
      const double disparity = rig.fx * rig.baseline / rangeOf(rig.ray(u, v));
      result.columns.at<float>(v, u) = static_cast<float>(u - disparity - rig.principalOffset());
      rows.at<float>(v, u) = static_cast<float>(v);
    }
  }
  cv::remap(right, shifted, result.columns, rows, cv::INTER_CUBIC);
  left.convertTo(result.left, CV_32F);
  shifted.convertTo(result.moved, CV_32F);
  cv::GaussianBlur(result.left, result.left, {}, 1.0);
  cv::GaussianBlur(result.moved, result.moved, {}, 1.0);
  return result;
}

/// Checks that left and moved view show the same, block by block from this row on, to a part of a pixel.
void expectSame(const GroundShift& shift, int first_row, int least) {
  cv::Mat gradient;
  cv::Sobel(0.5 * (shift.left + shift.moved), gradient, CV_32F, 1, 0, 3, 1.0 / 8);
  int checked = 0;
  for (int v = first_row; v + 30 <= 230; v += 30) {
    for (int u = 10; u + 50 <= 310; u += 50) {
      const cv::Rect block(u, v, 50, 30);
      double leftmost;
      cv::minMaxLoc(shift.columns(block), &leftmost);
      if (leftmost < 10) continue;
      EXPECT_NEAR(shiftOf(shift.left(block), shift.moved(block), gradient(block)), 0, 0.05) << block;
      ++checked;
    }
  }
  EXPECT_GE(checked, least);
}

TEST(Renderer, DisparityOfTheGroundIsThatOfThePlaneAfterRectification) {
  const Pair pair = renderPair(texturedGround(), kPose);
  const Attitude& a = kPose.attitude;
  const Eigen::Vector3d normal = axesOf(a.roll, a.pitch, a.yaw).transpose() * -Eigen::Vector3d::UnitZ();
  expectSame(
      moveByGround(pair, [&](const Eigen::Vector3d& ray) { return kPose.position.z() / normal.dot(ray); }),
      100, 8);
}

TEST(Renderer, DisparityOfCurvedGroundIsThatOfItsHeightField) {
  // Level up to 2 m before the threshold, then steeper and steeper, from 1 m behind it on rising by 4
  // degrees.
  SimulatorParameters p = texturedGround();
  p.profile.slope_after_deg = 4;
  p.profile.change_start = -2;
  p.profile.change_length = 3;
  const double rise = std::tan(4 * kDegree);
  const auto height = [&](double x) {
    const double z = x < -2 ? 0 : x < 1 ? rise / 6 * (x + 2) * (x + 2) : 1.5 * rise + rise * (x - 1);
    return z - rise / 6 * 4;  // 0 at the threshold
  };
  const Pair pair = renderPair(p, kPose);
  const Eigen::Matrix3d axes = axesOf(kPose.attitude.roll, kPose.attitude.pitch, kPose.attitude.yaw);
  expectSame(moveByGround(pair,
                          [&](const Eigen::Vector3d& ray) {
                            // Where the ray goes below the ground, by halving.
                            const Eigen::Vector3d direction = axes * ray;
                            double near = 0, far = 40;
                            for (int i = 0; i < 50; ++i) {
                              const double middle = 0.5 * (near + far);
                              const Eigen::Vector3d point = kPose.position + middle * direction;
                              (point.z() > height(point.x()) ? near : far) = middle;
                            }
                            return near;
                          }),
             70, 10);
}

TEST(Renderer, ACrestHidesTheGroundBehindIt) {
  // Rising by 2 degrees towards the camera's height and falling behind the crest: the ground ends at the
  // crest.
  SimulatorParameters p = plainBoard();
  p.runway.width = 0.01;
  p.runway.length = 0.1;
  p.surface.sky_horizon = p.surface.sky_zenith = 100;
  p.surface.cloud_contrast = 0;
  p.profile.slope_before_deg = 2;
  p.profile.slope_after_deg = -3;
  const CameraPose pose{{-30, 0, 0.5}, {0, 0, 0}};
  const Pair pair = renderPair(p, pose);
  const Eigen::Vector2d crest = imageOf(p, pose, pair.rig.left.calibration.R, false, {0, 0, 0});
  const int start = static_cast<int>(std::lround(crest.y())) - 4;
  double above = 0;
  for (const float grey : columnProfile(pair.left, static_cast<int>(std::lround(crest.x())), start, 9))
    above += (200.0 - grey) / 100.0;
  EXPECT_NEAR(start - 0.5 + above, crest.y(), 0.5) << "a crest is not smoothed within the pixel";
}

/// The pose's picture by ideal lenses, the picture enlarged this many times, blurred after it is drawn and
/// averaged back.
cv::Mat averagedPicture(SimulatorParameters p, int finer, double blur = 0) {
  p.left_camera = p.right_camera = {};
  p.rig = {};
  p.image.blur = 0;
  p.setPictures(320 * finer, 240 * finer, 280.0 * finer);
  cv::Mat picture = renderPair(p, kPose).left;
  if (blur > 0) cv::GaussianBlur(picture, picture, {}, blur * finer);
  cv::resize(picture, picture, cv::Size(320, 240), 0, 0, cv::INTER_AREA);
  return picture;
}

SimulatorParameters dashedBoard() {
  SimulatorParameters p = plainBoard();
  p.runway.centre_line_width = 0.05;
  p.runway.centre_dash_length = p.runway.centre_gap_length = 0.3;
  p.runway.centre_line_start = 0;
  p.runway.threshold_bars = 3;
  p.runway.threshold_bar_length = 0.5;
  p.runway.threshold_bar_width = p.runway.threshold_bar_gap = p.runway.threshold_centre_gap = 0.06;
  p.runway.threshold_bars_start = 0.1;
  return p;
}

TEST(Renderer, MarksAreAveragedOverThePixelDownToDashesFarSmallerThanIt) {
  const cv::Mat difference = averagedPicture(dashedBoard(), 1) - averagedPicture(dashedBoard(), 6);
  const cv::Mat ground = difference.rowRange(50, 240);
  EXPECT_LT(cv::norm(ground) / std::sqrt(ground.total()), 0.3) << "grey levels";
  EXPECT_LT(cv::norm(ground, cv::NORM_INF), 15) << "grey levels";
}

TEST(Renderer, BlurComesBeforePixelsDoAsInALens) {
  constexpr double kBlur = 0.4;
  SimulatorParameters p = dashedBoard();
  p.image.supersampling = 4;
  const cv::Mat lens = averagedPicture(p, 4, kBlur), afterwards = averagedPicture(p, 1, kBlur);
  p.left_camera = p.right_camera = {};
  p.rig = {};
  p.image.blur = kBlur;
  p.setPictures(320, 240, 280.0);
  cv::Mat drawn = renderPair(p, kPose).left;
  const double left = PixelFilter(p.image.supersampling, kBlur).blurLeft();
  ASSERT_LT(left, kBlur);
  cv::GaussianBlur(drawn, drawn, {}, left);
  const cv::Rect ground(8, 50, 304, 182);
  EXPECT_LT(cv::norm(drawn(ground) - lens(ground)), 0.6 * cv::norm(afterwards(ground) - lens(ground)));
}

TEST(Renderer, TextureKeepsTheBrightnessOfEveryRegionAtEveryDistance) {
  const cv::Mat difference = averagedPicture(texturedGround(), 1) - averagedPicture(texturedGround(), 6);
  for (int v = 40; v < 240; v += 20)
    for (int u = 0; u < 320; u += 40)
      EXPECT_NEAR(cv::mean(difference(cv::Rect(u, v, 40, 20)))[0], 0, 1.0) << v;
}

TEST(Renderer, ABoxHidesTheGroundBehindItsOutlineAndNothingElse) {
  SimulatorParameters p = plainBoard();
  p.image.blur = 0;
  const CameraRig rig = makeCameraRig(p).value();
  StandingObject box;
  box.low = {3, 0.5, 0};
  box.high = {3.4, 0.9, 0.6};
  box.brightness = 120;
  const Scene scene(p.runway, p.surface, 1);
  cv::Mat with, without, difference;
  Renderer(scene, {box}, p.image).render(rig.left, kPose, with);
  Renderer(scene, {}, p.image).render(rig.left, kPose, without);
  cv::absdiff(with, without, difference);
  const cv::Rect found = cv::boundingRect(difference > 0.5);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point((corner & 1) != 0 ? 3.4 : 3, (corner & 2) != 0 ? 0.9 : 0.5,
                                (corner & 4) != 0 ? 0.6 : 0);
    const Eigen::Vector2d pixel = imageOf(p, kPose, rig.left.calibration.R, false, point);
    left = std::min(left, pixel.x());
    right = std::max(right, pixel.x());
    top = std::min(top, pixel.y());
    bottom = std::max(bottom, pixel.y());
  }
  EXPECT_NEAR(found.x, left, 1.5);
  EXPECT_NEAR(found.x + found.width - 1, right, 1.5);
  EXPECT_NEAR(found.y, top, 1.5);
  EXPECT_NEAR(found.y + found.height - 1, bottom, 1.5);
}

TEST(Renderer, OneMaterialFarBelowTheHorizonNeedsNoSamples) {
  // The same with any number of them: what takes many times as long is done where it matters only.
  SimulatorParameters one = texturedGround(), many = texturedGround();
  one.image.blur = many.image.blur = 0;
  one.image.supersampling = 1;
  many.image.supersampling = 4;
  const cv::Rect below(0, 180, 320, 60);
  EXPECT_EQ(cv::norm(renderPair(one, kPose).left(below), renderPair(many, kPose).left(below), cv::NORM_INF),
            0);
}

TEST(Objects, AreAsLargeAsAskedAtMostAndOfManyShapes) {
  SimulatedObjectsParameters p;
  p.boxes = p.poles = 200;
  p.box_size = 10;
  p.pole_height = 6, p.pole_width = 0.2;
  const std::vector<StandingObject> objects = placeObjects(p, 30, 7);
  ASSERT_EQ(objects.size(), 400u);
  Eigen::Array3f least = Eigen::Array3f::Constant(1e9f), most = Eigen::Array3f::Zero();
  int long_ones = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Array3f size = (objects[i].high - objects[i].low).array();
    least = least.min(size);
    most = most.max(size);
    long_ones += size.x() > size.y();
    const Eigen::Array3f pole = (objects[200 + i].high - objects[200 + i].low).array();
    EXPECT_NEAR(pole.x(), 0.2, 1e-4);
    EXPECT_NEAR(pole.y(), 0.2, 1e-4);
    EXPECT_GE(pole.z(), 3 - 1e-4);
    EXPECT_LE(pole.z(), 6 + 1e-4);
  }
  EXPECT_TRUE((most <= 10.001f).all()) << most.transpose();
  EXPECT_TRUE((most > 9.5f).all()) << most.transpose();
  EXPECT_TRUE((least < 4).all()) << least.transpose();
  EXPECT_TRUE((least > 1.9f).all()) << least.transpose();
  EXPECT_NEAR(long_ones, 100, 30) << "as many are longer than wide as the other way round";
}

TEST(Objects, StandBesideTheRunwayWhereAsked) {
  SimulatedObjectsParameters p;
  p.boxes = p.poles = 100;
  p.clearance = 5, p.band = 20, p.first = 100, p.last = 300;
  const std::vector<StandingObject> objects = placeObjects(p, 30, 7);
  ASSERT_EQ(objects.size(), 200u);
  int on_the_left = 0;
  for (const StandingObject& object : objects) {
    const bool left = object.low.y() > 0;
    on_the_left += left ? 1 : 0;
    EXPECT_GE(left ? object.low.y() : -object.high.y(), 20 - 1e-4);
    EXPECT_EQ(object.low.z(), 0);
    EXPECT_GT(object.high.z(), 0);
    EXPECT_GE(object.low.x(), 100);
    EXPECT_LE(object.low.x(), 300);
  }
  EXPECT_GT(on_the_left, 60);
  EXPECT_LT(on_the_left, 140);
}

}  // namespace
}  // namespace uav_landing
