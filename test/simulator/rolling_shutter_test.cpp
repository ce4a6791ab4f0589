#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/lens.h"
#include "uav_landing/simulator/approach_simulator.h"
#include "uav_landing/simulator/parameter_file.h"

namespace uav_landing {
namespace {

using RowDirection = SimulatedImageParameters::RowDirection;
constexpr double kAhead = 61, kSide = 6;  // m, middles of two bright squares of 1 m from the threshold
constexpr int kFrame = 3;

/// Two bright squares on dark even ground, seen by a rig with lenses from 15 m and 60 m before them.
SimulatorParameters twoSquares() {
  SimulatorParameters p;
  p.image.width = 320;
  p.image.height = 240;
  p.image.noise = 0;
  makeRealistic(p.left_camera, p.right_camera, p.rig);
  p.runway.edge_line_width = p.runway.centre_line_width = p.runway.threshold_line_width = 0;
  p.runway.threshold_bars = 0;
  p.runway.tyre_marks = 0;
  p.runway.aiming_point_distance = kAhead - 0.5;
  p.runway.aiming_point_length = p.runway.aiming_point_width = 1;
  p.runway.aiming_point_gap = 2 * kSide - 1;
  p.surface.runway_brightness = p.surface.grass_brightness = 40;
  p.surface.runway_contrast = p.surface.grass_contrast = 0;
  p.surface.sky_horizon = p.surface.sky_zenith = 40;
  p.surface.cloud_contrast = 0;
  p.surface.visibility = 1e6;
  p.path.duration = 0.5;
  p.path.rate = 10;
  p.path.start_height = 15;
  p.path.start_x = 0;
  p.path.speed = 0;
  p.path.pitch_deg = -5;
  p.path.flare_height = 0;
  p.wobble.roll_deg = p.wobble.pitch_deg = p.wobble.yaw_deg = p.wobble.sway = p.wobble.heave = 0;
  return p;
}

/// Middle of the bright pixels in one half of the sides of a picture.
Eigen::Vector2d squareIn(const cv::Mat& image, bool right_one, double split) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.cols; ++column) {
      const double weight = image.at<uint8_t>(row, column) - 40;
      if ((column > split) != right_one || weight < 4) continue;
      sum += weight * Eigen::Vector2d(column, row);
      weights += weight;
    }
  EXPECT_GT(weights, 500) << "a square is in view";
  return sum / weights;
}

/// Raw pixel at which a camera sees a point of the ground at one moment.
Eigen::Vector2d imageOf(const SimulatorParameters& p, const ApproachSimulator& simulator, double time,
                        bool right_camera, const Eigen::Vector3d& point) {
  const CameraPose pose = simulator.pose(time);
  const Eigen::Matrix3d axes = axesOf(pose.attitude.roll, pose.attitude.pitch, pose.attitude.yaw);
  const Eigen::Vector3d rectified = axes.transpose() * (point - pose.position);
  const Eigen::Vector3d raw = simulator.rig().left.calibration.R.transpose() * rectified;
  return right_camera ? throughLens(p.right_camera, leftToRight(p.rig, raw))
                      : throughLens(p.left_camera, raw);
}

/// Where a camera whose lines have times of their own sees a point: the line that looks at the point at just
/// the time at which the point lies on that line. Found by bisection over all lines.
Eigen::Vector2d seenAt(const SimulatorParameters& p, const ApproachSimulator& simulator, bool right_camera,
                       const Eigen::Vector3d& point) {
  const bool columns = p.image.row_direction == RowDirection::kColumns;
  const double lines = columns ? p.image.width : p.image.height;
  const double stamp = kFrame / p.path.rate;
  const auto at = [&](double line) {
    const double time = stamp + ((line + 0.5) / lines - p.image.stamp_row) * p.image.readout_time;
    return imageOf(p, simulator, time, right_camera, point);
  };
  double low = 0, high = lines - 1;
  for (int i = 0; i < 60; ++i) {
    const double line = 0.5 * (low + high);
    (at(line)[columns ? 0 : 1] > line ? low : high) = line;
  }
  return at(low);
}

/// Mean of what is seen of a square.
Eigen::Vector2d expectedOf(const SimulatorParameters& p, const ApproachSimulator& simulator,
                           bool right_camera, double side) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += seenAt(p, simulator, right_camera,
                    {kAhead + (i + 0.5) / kSteps - 0.5, side + (j + 0.5) / kSteps - 0.5, 0});
  return sum / (kSteps * kSteps);
}

/// Both squares in both pictures lie where they must; returns by how much the most displaced of them lies
/// elsewhere than with all rows at the stamp, px.
double checkSquares(const SimulatorParameters& p) {
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  const ApproachSimulator::Frame frame = simulator.frame(kFrame);
  double most = 0;
  for (const bool right_camera : {false, true})
    for (const double side : {-kSide, kSide}) {
      SCOPED_TRACE(std::string(right_camera ? "right" : "left") + " camera, y " + std::to_string(side));
      const double split = seenAt(p, simulator, right_camera, {kAhead, 0, 0}).x();
      const Eigen::Vector2d found = squareIn(right_camera ? frame.right : frame.left, side < 0, split);
      const Eigen::Vector2d expected = expectedOf(p, simulator, right_camera, side);
      EXPECT_NEAR(found.x(), expected.x(), 0.08);
      EXPECT_NEAR(found.y(), expected.y(), 0.08);
      const Eigen::Vector2d at_once = imageOf(p, simulator, frame.time, right_camera, {kAhead, side, 0});
      most = std::max(most, (found - at_once).norm());
    }
  return most;
}

/// Turns fast enough to move a pixel by pixels within the time of the rows.
SimulatorParameters pitching() {
  SimulatorParameters p = twoSquares();
  p.image.readout_time = 0.06;
  p.wobble.pitch_deg = 4;
  p.wobble.pitch_period = 0.4;
  return p;
}

TEST(RollingShutter, PointLiesWhereItsRowSeesItWhilePitching) { EXPECT_GT(checkSquares(pitching()), 1); }

TEST(RollingShutter, PointLiesWhereItsRowSeesItWhileRolling) {
  SimulatorParameters p = twoSquares();
  p.image.readout_time = 0.06;
  p.wobble.roll_deg = 15;
  p.wobble.roll_period = 0.4;
  EXPECT_GT(checkSquares(p), 1);
}

TEST(RollingShutter, PointLiesWhereItsRowSeesItInForwardFlight) {
  SimulatorParameters p = twoSquares();
  p.image.readout_time = 0.1;
  p.image.stamp_row = 0;
  p.path.speed = 60;
  p.path.start_x = -kFrame / p.path.rate * p.path.speed;  // over the threshold at the stamp
  EXPECT_GT(checkSquares(p), 3);
}

TEST(RollingShutter, StampBelongsToTheRowAsked) {
  for (const double row : {-0.2, 0.0, 0.5, 1.0}) {
    SCOPED_TRACE(row);
    SimulatorParameters p = pitching();
    p.image.stamp_row = row;
    checkSquares(p);
  }
}

TEST(RollingShutter, NegativeTimeReadsFromTheBottom) {
  for (const double row : {0.0, 0.5, 1.0}) {
    SCOPED_TRACE(row);
    SimulatorParameters p = pitching();
    p.image.readout_time = -0.06;
    p.image.stamp_row = row;
    checkSquares(p);
  }
}

TEST(RollingShutter, ColumnsAreReadFromTheLeft) {
  SimulatorParameters p = pitching();
  p.image.row_direction = RowDirection::kColumns;
  checkSquares(p);
  p.image.readout_time = -0.06;
  EXPECT_GT(checkSquares(p), 1);
}

TEST(RollingShutter, TruthIsThatOfTheStamp) {
  SimulatorParameters p = pitching();
  p.path.speed = 20;
  const Truth rolling = ApproachSimulator::create(p)->frame(kFrame).truth;
  p.image.readout_time = 0;
  const Truth at_once = ApproachSimulator::create(p)->frame(kFrame).truth;
  EXPECT_EQ(rolling.pitch, at_once.pitch);
  EXPECT_EQ(rolling.height, at_once.height);
  EXPECT_EQ(rolling.approach_angle, at_once.approach_angle);
}

TEST(RollingShutter, ObjectsMoveWithTheGround) {
  // Each row of the rolling picture is that row of a picture taken at once at the row's time.
  SimulatorParameters p = twoSquares();
  p.image.blur = 0;  // mixes rows
  p.image.readout_time = 0.06;
  p.runway.aiming_point_length = 0;
  p.wobble.yaw_deg = 4;
  p.wobble.yaw_period = 0.4;
  p.objects.poles = 4;
  p.objects.pole_height = 14;
  p.objects.pole_width = 0.8;
  p.objects.clearance = -20;
  p.objects.band = 4;
  p.objects.first = p.objects.last = 50;
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  const cv::Mat rolling = simulator.frame(kFrame).left;
  p.image.readout_time = 0;
  const cv::Mat at_once = ApproachSimulator::create(p)->frame(kFrame).left;
  int displaced = 0;
  for (const int row : {120, 140, 160, 180}) {
    SimulatorParameters at_row = p;
    at_row.path.rate = 1 / (kFrame / p.path.rate + ((row + 0.5) / 240 - 0.5) * 0.06);
    const cv::Mat expected = ApproachSimulator::create(at_row)->frame(1).left;
    EXPECT_LE(cv::norm(rolling.row(row), expected.row(row), cv::NORM_INF), 1) << row;
    if (cv::norm(rolling.row(row), at_once.row(row), cv::NORM_INF) > 20) ++displaced;
  }
  EXPECT_GE(displaced, 2) << "rows in which the poles stand elsewhere";
}

TEST(RollingShutter, WithoutTimeOrVibrationPicturesStayAsTheyAre) {
  SimulatorParameters p;
  p.setPictures(160, 120, 138);
  p.objects.boxes = 8;
  p.objects.first = -300;
  const ApproachSimulator before = ApproachSimulator::create(p).value();
  p.image.stamp_row = 0;
  p.image.row_direction = RowDirection::kColumns;
  p.vibration.frequency = 7;
  p.vibration.start = 1;
  const ApproachSimulator after = ApproachSimulator::create(p).value();
  for (const int frame : {0, 7}) {
    EXPECT_EQ(cv::norm(before.frame(frame).left, after.frame(frame).left, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(before.frame(frame).right, after.frame(frame).right, cv::NORM_INF), 0);
  }
}

TEST(RollingShutter, RowsOfACameraThatRestsAreThoseOfAPictureTakenAtOnce) {
  SimulatorParameters p = twoSquares();
  p.surface.grass_contrast = 0.1;
  p.objects.boxes = 8;
  const cv::Mat at_once = ApproachSimulator::create(p)->frame(kFrame).left;
  p.image.readout_time = 0.05;
  EXPECT_EQ(cv::norm(at_once, ApproachSimulator::create(p)->frame(kFrame).left, cv::NORM_INF), 0);
}

std::string failureOf(const SimulatorParameters& p) {
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(p);
  return simulator ? "" : simulator.error().detail;
}

TEST(RollingShutter, LongerThanTheTimeBetweenPairsIsRefused) {
  SimulatorParameters p = twoSquares();
  p.image.readout_time = 0.1;
  EXPECT_EQ(failureOf(p), "") << "as long as it";
  for (const double readout : {0.12, -0.12}) {
    p.image.readout_time = readout;
    EXPECT_EQ(failureOf(p), std::string("image/readout_time: ") + (readout < 0 ? "-0.12" : "0.12") +
                                " s is longer than the 0.1 s from one pair to the next (path/rate)");
  }
}

TEST(RollingShutter, RowThatTouchesTheGroundIsRefused) {
  SimulatorParameters p = twoSquares();
  p.path.start_height = 2;
  p.path.glide_angle_deg = 30;
  p.path.speed = 7;  // 1.75 m lower after half a second, 2.1 m with half the rows more
  EXPECT_EQ(failureOf(p), "");
  p.image.readout_time = 0.1;
  p.image.stamp_row = 0;
  EXPECT_EQ(failureOf(p), "path/duration: a camera touches the ground after 0.5 s");
}

std::string refusalOf(const std::string& yaml) {
  const Expected<SimulatorParameters> parameters = parseSimulatorParameters(yaml, "my.yaml");
  return parameters ? "" : parameters.error().detail;
}

TEST(RollingShutter, BadNumbersAndWordsAreNamed) {
  EXPECT_EQ(refusalOf("image: {readout_time: .nan}"),
            "my.yaml: image/readout_time: nan is out of range, expected -0.5 to 0.5 s");
  EXPECT_EQ(refusalOf("image: {stamp_row: 3}"),
            "my.yaml: image/stamp_row: 3 is out of range, expected -2 to 2 image heights");
  EXPECT_EQ(refusalOf("image: {row_direction: diagonal}"),
            "my.yaml: image/row_direction: 'diagonal' is not a choice, expected rows or columns");
  EXPECT_EQ(refusalOf("vibration: {pitch_deg: -1}"),
            "my.yaml: vibration/pitch_deg: -1 is out of range, expected 0 to 10 deg");
  EXPECT_EQ(refusalOf("vibration: {frequency: 0}"),
            "my.yaml: vibration/frequency: 0 is out of range, expected 0.1 to 1000 Hz");
  EXPECT_EQ(refusalOf("vibration: {roll_deg: .nan}"),
            "my.yaml: vibration/roll_deg: nan is out of range, expected 0 to 10 deg");
}

}  // namespace
}  // namespace uav_landing
