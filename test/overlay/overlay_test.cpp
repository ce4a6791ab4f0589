#include "uav_landing/overlay/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr int kGrey = 100;

StereoRig makeRig() { return test::rigOf({320, 240}, 300, {160, 120}, 150, 0.5); }

OverlayParameters twice() {
  OverlayParameters parameters;
  parameters.scale = 2;
  return parameters;
}

LandingResult tracking() {
  LandingResult landing;
  landing.status = Status::kTracking;
  landing.height_valid = landing.angle_valid = true;
  landing.height = 1.5;
  landing.height_variance = 1e-4;
  return landing;
}

/// How colourful a pixel is: 0 for grey. What is not drawn on stays grey, as the image was.
int colourfulness(const cv::Mat& picture, double column, double row) {
  const auto pixel =
      picture.at<cv::Vec3b>(static_cast<int>(std::lround(row)), static_cast<int>(std::lround(column)));
  return std::max({pixel[0], pixel[1], pixel[2]}) - std::min({pixel[0], pixel[1], pixel[2]});
}

/// Place of an image pixel's middle in a picture twice as large: pixel 0 covers 0..1, its middle is 0.5.
double enlarged(double pixel) { return 2 * pixel + 0.5; }

class Overlay : public ::testing::Test {
 protected:
  cv::Mat draw() const { return drawOverlay(rig, image, {stereo, approach, landing}, twice()); }

  const StereoRig rig = makeRig();
  const cv::Mat image{rig.size, CV_8U, cv::Scalar(kGrey)};
  StereoDepthResult stereo;
  ApproachAngleResult approach;
  LandingResult landing = tracking();
};

TEST_F(Overlay, NothingFoundLeavesThePictureGreyAndHasAStripBelow) {
  const cv::Mat picture = draw();
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.cols, 640);
  EXPECT_GT(picture.rows, 480);
  for (int row = 0; row < 480; row += 7) {
    for (int column = 0; column < 640; column += 7) ASSERT_EQ(colourfulness(picture, column, row), 0);
  }
}

TEST_F(Overlay, DoesNotTouchTheImage) {
  approach.foe = {10, 10};
  draw();
  EXPECT_EQ(cv::countNonZero(image != kGrey), 0);
}

TEST_F(Overlay, HorizonOfThePlaneIsWhereALevelRayGoes) {
  // Camera pitched 10 degrees down, 5 degrees rolled: the horizon is tan(10) f above the centre, turned by
  // the roll.
  const double pitch = 10 * kDegree, roll = 5 * kDegree;
  stereo.plane.g =
      Eigen::Vector3d(std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll), std::sin(pitch)) /
      2;
  const cv::Mat picture = draw();
  for (const double u : {40.0, 160.0, 280.0}) {
    const double v = 120 - (300 * std::tan(pitch) + (u - 160) * std::sin(roll)) / std::cos(roll);
    EXPECT_GT(colourfulness(picture, enlarged(u), enlarged(v)), 80) << u;
    EXPECT_EQ(colourfulness(picture, enlarged(u), enlarged(v + 10)), 0) << u;
    EXPECT_EQ(colourfulness(picture, enlarged(u), enlarged(v - 10)), 0) << u;
  }
}

TEST_F(Overlay, FusedHorizonIsDrawnWithoutAStereoPlane) {
  approach.n = {0, 1, 0};
  EXPECT_GT(colourfulness(draw(), enlarged(20), enlarged(120)), 80);
}

TEST_F(Overlay, FocusOfExpansionIsACross) {
  approach.foe = {200, 150};
  const cv::Mat picture = draw();
  EXPECT_GT(colourfulness(picture, enlarged(200), enlarged(150)), 80);
  EXPECT_GT(colourfulness(picture, enlarged(200) - 8, enlarged(150)), 80);
  EXPECT_GT(colourfulness(picture, enlarged(200), enlarged(150) + 8), 80);
  EXPECT_EQ(colourfulness(picture, enlarged(200) - 8, enlarged(150) + 8), 0);
}

TEST_F(Overlay, VanishingPointIsACircleAroundTheDirection) {
  approach.vanishing_direction = Eigen::Vector3d(30, -60, 300).normalized();  // pixel (190, 60)
  const cv::Mat picture = draw();
  EXPECT_GT(colourfulness(picture, enlarged(190) - 7, enlarged(60)), 80);
  EXPECT_EQ(colourfulness(picture, enlarged(190), enlarged(60)), 0);
}

TEST_F(Overlay, VanishingPointAndFocusOfExpansionHaveTheirNames) {
  const auto coloured = [&](const cv::Mat& picture, double column, double row) {
    int count = 0;  // beside the mark, to the right and above
    for (int down = -20; down <= -5; ++down)
      for (int right = 11; right <= 28; ++right)
        count += colourfulness(picture, column + right, row + down) > 80;
    return count;
  };
  const cv::Mat none = draw();
  approach.vanishing_direction = Eigen::Vector3d(30, -60, 300).normalized();  // pixel (190, 60)
  approach.foe = {100, 200};
  const cv::Mat picture = draw();
  EXPECT_EQ(coloured(none, enlarged(190), enlarged(60)), 0);
  EXPECT_GT(coloured(picture, enlarged(190), enlarged(60)), 20);
  EXPECT_EQ(coloured(none, enlarged(100), enlarged(200)), 0);
  EXPECT_GT(coloured(picture, enlarged(100), enlarged(200)), 20);
}

TEST_F(Overlay, VanishingPointBehindTheCameraIsNotDrawn) {
  const cv::Mat without = draw();
  approach.vanishing_direction = Eigen::Vector3d(30, -60, -300).normalized();
  EXPECT_EQ(cv::norm(draw(), without, cv::NORM_INF), 0);
}

TEST_F(Overlay, LinesThroughTheVanishingPointAreBrightOthersDim) {
  ApproachAngleResult::Line inlier, other;
  inlier.a = {40, 200};
  inlier.b = {120, 200};
  inlier.inlier = true;
  other.a = {180, 200};
  other.b = {260, 200};
  approach.left.lines = {inlier, other};
  for (const cv::Mat& picture : {draw(), drawLines(image, approach.left, twice())}) {
    EXPECT_GT(colourfulness(picture, enlarged(80), enlarged(200)), 150);
    EXPECT_GT(colourfulness(picture, enlarged(220), enlarged(200)), 20);
    EXPECT_LT(colourfulness(picture, enlarged(220), enlarged(200)), 100);
    EXPECT_EQ(colourfulness(picture, enlarged(150), enlarged(200)), 0);
  }
}

TEST_F(Overlay, NearMatchesAreRedFarOnesBlueThoseOffThePlaneDim) {
  stereo.points.resize(3);
  stereo.points[0] = {50, 220, 60, 0.1, true};
  stereo.points[1] = {150, 220, 6, 0.1, true};
  stereo.points[2] = {250, 220, 100, 0.1, false};
  const cv::Mat picture = draw();
  const auto at = [&](double u) {
    return picture.at<cv::Vec3b>(static_cast<int>(enlarged(220)), static_cast<int>(enlarged(u)));
  };
  EXPECT_GT(at(50)[2], at(50)[0]);
  EXPECT_GT(at(150)[0], at(150)[2]);
  EXPECT_LT(colourfulness(picture, enlarged(250), enlarged(220)), 60);
}

TEST_F(Overlay, FarAwayAndUnknownMarksDoNoHarm) {
  approach.foe = {1e12, -1e12};
  approach.vanishing_direction = Eigen::Vector3d(1, 0, 1e-9).normalized();
  stereo.plane.g = {0, 1e-9, 0.5};  // a horizon a million pixels away
  EXPECT_NO_THROW(draw());
}

TEST_F(Overlay, StripShowsStatusAndReasonOfAnInvalidEstimate) {
  const auto strip = [](const cv::Mat& picture) { return picture.rowRange(480, picture.rows); };
  const cv::Mat good = draw();
  landing.height_valid = landing.angle_valid = false;
  landing.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  const cv::Mat bad = draw();
  EXPECT_GT(cv::norm(strip(good), strip(bad), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(good.rowRange(0, 480), bad.rowRange(0, 480), cv::NORM_INF), 0);
}

TEST_F(Overlay, StripShowsTheProtectionLevelInAnotherColourWhenItIsAboveTheAlertLimit) {
  const auto corner = [](const cv::Mat& picture) {
    return picture(cv::Rect(picture.cols / 2, 480 + 42, picture.cols / 2, 20)).clone();
  };
  landing.height_protection_level = 0.2;
  landing.height_alert_limit = 0.5;
  const cv::Mat within = corner(draw());
  landing.height_protection_level = 0.4;
  EXPECT_GT(cv::norm(within, corner(draw()), cv::NORM_INF), 0) << "another level";
  landing.height_protection_level = 0.2;
  landing.height_alert_limit = 0.1;
  const auto reddest = [](const cv::Mat& picture) {
    std::vector<cv::Mat> channels;
    cv::split(picture, channels);
    double most = 0;
    cv::minMaxLoc(channels[2] - channels[0], nullptr, &most);
    return most;
  };
  EXPECT_LT(reddest(within), 60);
  EXPECT_GT(reddest(corner(draw())), 120);
}

TEST_F(Overlay, LongReasonStaysInsideTheStrip) {
  landing.failure = {Reason::kInputInvalid, std::string(300, 'W')};
  landing.height_protection_level = landing.height_alert_limit = kUnknown;
  const cv::Mat picture = draw();
  const cv::Mat margin = picture(cv::Rect(picture.cols - 4, 480, 4, picture.rows - 480));
  const cv::Mat panel(margin.size(), margin.type(),
                      picture.at<cv::Vec3b>(picture.rows - 1, picture.cols - 1));
  EXPECT_EQ(cv::norm(margin, panel, cv::NORM_INF), 0);
}

constexpr int kPicture = 480;  // rows above the strip of a picture that is 640 columns wide

/// The strip's rows of labels, values, status and the rest of the reason.
cv::Mat labels(const cv::Mat& picture) { return picture.rowRange(kPicture, kPicture + 18).clone(); }
cv::Mat values(const cv::Mat& picture) { return picture.rowRange(kPicture + 20, kPicture + 40).clone(); }
cv::Mat statusLine(const cv::Mat& picture) { return picture.rowRange(kPicture + 42, kPicture + 59).clone(); }
cv::Mat reasonLine(const cv::Mat& picture) { return picture.rowRange(kPicture + 61, kPicture + 78).clone(); }

/// Where two pictures differ; empty when they do not.
cv::Rect changed(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference, grey;
  cv::absdiff(a, b, difference);
  cv::cvtColor(difference, grey, cv::COLOR_BGR2GRAY);
  return cv::boundingRect(grey);
}

/// Where there is writing on the panel.
cv::Rect written(const cv::Mat& part) {
  return changed(part, cv::Mat(part.size(), part.type(), part.at<cv::Vec3b>(0, 0)));
}

/// Pixels filled with a strong red.
int redPixels(const cv::Mat& part) {
  int count = 0;
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.cols; ++column) {
      const auto pixel = part.at<cv::Vec3b>(row, column);
      count += pixel[2] > 200 && pixel[0] < 150 && pixel[1] < 150;
    }
  }
  return count;
}

cv::Mat leftHalf(const cv::Mat& part) { return part.colRange(0, 200); }
cv::Mat middle(const cv::Mat& part) { return part.colRange(260, 450); }

TEST_F(Overlay, StripMarksWhatIsNotValidAtItsNameAndTurnsItsNumberRed) {
  landing.approach_angle = 6 * kDegree;
  landing.approach_angle_variance = 1e-6;
  const cv::Mat good = draw();
  EXPECT_EQ(redPixels(labels(good)) + redPixels(values(good)), 0);
  landing.height_valid = false;
  const cv::Mat no_height = draw();
  EXPECT_GT(redPixels(leftHalf(labels(no_height))), 300);
  EXPECT_GT(redPixels(leftHalf(values(no_height))), 30);
  EXPECT_EQ(redPixels(middle(labels(no_height))) + redPixels(middle(values(no_height))), 0);
  landing.height_valid = true;
  landing.angle_valid = false;
  const cv::Mat no_angle = draw();
  EXPECT_GT(redPixels(middle(labels(no_angle))), 300);
  EXPECT_GT(redPixels(middle(values(no_angle))), 30);
  EXPECT_EQ(redPixels(leftHalf(labels(no_angle))) + redPixels(leftHalf(values(no_angle))), 0);
}

TEST_F(Overlay, ReasonIsAsLargeHoweverLongItIs) {
  landing.height_valid = false;
  landing.failure = {Reason::kUncertain, "H"};
  const cv::Mat brief = draw();
  landing.failure.detail =
      "H height 18.96 m has a protection level of 1.887 m because of surface_below, alert limit 0.948 m";
  const cv::Mat lengthy = draw();
  const cv::Mat beginning = statusLine(brief).colRange(0, 180);
  EXPECT_EQ(cv::norm(beginning, statusLine(lengthy).colRange(0, 180), cv::NORM_INF), 0);
  EXPECT_EQ(written(reasonLine(brief)).area(), 0);
  EXPECT_GE(written(reasonLine(lengthy)).height, 9);
  EXPECT_EQ(brief.size(), lengthy.size());
}

TEST_F(Overlay, AttitudeIsUnderItsNamesAndInsideTheStrip) {
  landing.pitch = landing.roll = landing.yaw = 0;
  const cv::Mat level = values(draw());
  std::vector<cv::Rect> columns;
  for (double LandingResult::*angle : {&LandingResult::pitch, &LandingResult::roll, &LandingResult::yaw}) {
    landing.*angle = (angle == &LandingResult::pitch ? -80.5 : -170.5) * kDegree;
    columns.push_back(changed(level, values(draw())));
    landing.*angle = 0;
  }
  // The names begin at 448, 508 and 570.
  EXPECT_NEAR(columns[0].x, 448, 4);
  EXPECT_NEAR(columns[1].x, 508, 4);
  EXPECT_NEAR(columns[2].x, 570, 4);
  EXPECT_LT(columns[0].br().x, columns[1].x);
  EXPECT_LT(columns[1].br().x, columns[2].x);
  EXPECT_LE(columns[2].br().x, 632);
}

TEST_F(Overlay, EveryInstrumentHasItsName) {
  const cv::Mat names = labels(draw());
  for (const int column : {10, 174, 274, 448, 508, 570}) {
    const cv::Rect name = written(names.colRange(column - 4, column + 40));
    EXPECT_NEAR(name.x, 4, 2) << column;
    EXPECT_GT(name.width, 15) << column;
    EXPECT_GT(name.height, 5) << column;
  }
}

TEST_F(Overlay, TheMarkOfWhatIsNotValidLeavesItsNameReadable) {
  const cv::Mat good = labels(draw());
  landing.height_valid = landing.angle_valid = false;
  const cv::Mat bad = labels(draw());
  for (const int column : {10, 274}) {
    const int width = column == 10 ? 40 : 95;  // of HEIGHT and APPROACH ANGLE
    EXPECT_EQ(
        cv::norm(good.colRange(column, column + width), bad.colRange(column, column + width), cv::NORM_INF),
        0);
  }
  EXPECT_GT(redPixels(bad.colRange(60, 110)), 200);
  EXPECT_GT(redPixels(bad.colRange(375, 440)), 200);
}

TEST_F(Overlay, TheAttitudeIsInDegrees) {
  // What is written as one angle looks like another one that is the same.
  const auto writtenAt = [&](int column) { return values(draw()).colRange(column, column + 50).clone(); };
  landing.pitch = landing.roll = landing.yaw = 12.3 * kDegree;
  EXPECT_EQ(cv::norm(writtenAt(448), writtenAt(508), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(writtenAt(448), writtenAt(570), cv::NORM_INF), 0);
  // 12.3 degrees are four letters, as 12.34 m/s begins with.
  landing.pitch = 12 * kDegree;
  EXPECT_GT(cv::norm(writtenAt(448), writtenAt(508), cv::NORM_INF), 0);
}

TEST_F(Overlay, TheAngleAndItsDeviationAreInDegrees) {
  // "16.25 +-0.50 m" and "16.25 +-0.50 deg" begin alike.
  landing.height = 16.25;
  landing.height_variance = 0.25;
  landing.approach_angle = 16.25 * kDegree;
  landing.approach_angle_variance = std::pow(0.5 * kDegree, 2);
  const cv::Mat row = values(draw());
  const int width = 95;  // of what they have in common, nearly
  EXPECT_GT(written(row.colRange(10, 10 + width)).width, 80);
  EXPECT_EQ(cv::norm(row.colRange(10, 10 + width), row.colRange(274, 274 + width), cv::NORM_INF), 0);
}

TEST_F(Overlay, NumbersStayAsWideWhenTheyChange) {
  const auto width = [&](double height, double stddev) {
    landing.height = height;
    landing.height_variance = stddev * stddev;
    return written(leftHalf(values(draw())).colRange(0, 170)).width;
  };
  EXPECT_NEAR(width(8.284, 0.01), width(8.28, 0.0143), 2);
  EXPECT_NEAR(width(18.28, 0.2), width(18.3, 0.143), 2);
}

TEST_F(Overlay, ZeroHasNoSign) {
  landing.vertical_speed = 0;
  landing.approach_angle = landing.approach_angle_variance = landing.pitch = 0;
  const cv::Mat zero = draw();
  landing.vertical_speed = 0.004;
  landing.approach_angle = landing.pitch = -0.004 * kDegree;
  EXPECT_EQ(cv::norm(zero, draw(), cv::NORM_INF), 0);
}

TEST_F(Overlay, MatchesAreMarkedInBothViews) {
  stereo.points = {{200, 180, 50, 0.1, true}};
  const cv::Mat picture = drawMatches(rig, image, image, stereo, twice());
  EXPECT_EQ(picture.size(), cv::Size(1280, 480));
  // The right image has the point 50 + (160 - 150) columns farther left.
  EXPECT_GT(colourfulness(picture, enlarged(200) + 2.5, enlarged(180)), 80);
  EXPECT_GT(colourfulness(picture, enlarged(320 + 140) - 2.5, enlarged(180)), 80);
  EXPECT_EQ(colourfulness(picture, enlarged(320 + 150), enlarged(180)), 0);
}

TEST(OverlayScale, MakesSmallImagesAtLeast640Wide) {
  OverlayParameters parameters;
  EXPECT_EQ(overlayScale(320, parameters), 2);
  EXPECT_EQ(overlayScale(300, parameters), 3);
  EXPECT_EQ(overlayScale(640, parameters), 1);
  EXPECT_EQ(overlayScale(1392, parameters), 1);
  parameters.scale = 4;
  EXPECT_EQ(overlayScale(1392, parameters), 4);
}

}  // namespace
}  // namespace uav_landing
