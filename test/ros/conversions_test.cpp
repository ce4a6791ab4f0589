#include "conversions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "landing_messages.h"
#include "message_fields.h"
#include "message_parts.h"

using namespace uav_landing;

namespace {

// Every call gives another number that no float32 can hold.
double next() {
  static double value = 0.1;
  return value += 1.0 / 3;
}

template <class Matrix>
void fill(Matrix& matrix) {
  for (int row = 0; row < matrix.rows(); ++row)
    for (int column = 0; column < matrix.cols(); ++column) matrix(row, column) = next();
}

ApproachAngleResult::View distinctView() {
  ApproachAngleResult::View view;
  view.lines = {{{next(), next()}, {next(), next()}, true}, {{next(), next()}, {next(), next()}, false}};
  view.failure = {Reason::kNoVanishingPoint, "lines: do not agree"};
  fill(view.vanishing_direction);
  fill(view.vanishing_covariance);
  return view;
}

void expectEqual(const ApproachAngleResult::View& a, const ApproachAngleResult::View& b) {
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].a, b.lines[i].a);
    EXPECT_EQ(a.lines[i].b, b.lines[i].b);
    EXPECT_EQ(a.lines[i].inlier, b.lines[i].inlier);
  }
  EXPECT_EQ(a.failure.message(), b.failure.message());
  EXPECT_EQ(a.vanishing_direction, b.vanishing_direction);
  EXPECT_EQ(a.vanishing_covariance, b.vanishing_covariance);
}

ApproachAngleResult::Motion distinctMotion() {
  ApproachAngleResult::Motion motion;
  motion.failure = {Reason::kNoMotion, ""};
  motion.duration = next();
  motion.matches = 12;
  motion.inliers = 11;
  fill(motion.rotation);
  fill(motion.translation_over_height);
  fill(motion.turn_rate);
  fill(motion.covariance);
  motion.angle = next();
  motion.angle_variance = next();
  motion.row_motion = next();
  motion.row_motion_limit = next();
  fill(motion.normal);
  fill(motion.normal_covariance);
  return motion;
}

void expectEqual(const ApproachAngleResult::Motion& a, const ApproachAngleResult::Motion& b) {
  EXPECT_EQ(a.failure.message(), b.failure.message());
  EXPECT_EQ(a.duration, b.duration);
  EXPECT_EQ(a.matches, b.matches);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.translation_over_height, b.translation_over_height);
  EXPECT_EQ(a.turn_rate, b.turn_rate);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.angle_variance, b.angle_variance);
  EXPECT_EQ(a.row_motion, b.row_motion);
  EXPECT_EQ(a.row_motion_limit, b.row_motion_limit);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.normal_covariance, b.normal_covariance);
}

std_msgs::Header header() {
  std_msgs::Header header;
  header.stamp = ros::Time(1700000000, 123456789);
  header.frame_id = "left_rect";
  return header;
}

StereoDepthResult distinctStereoDepth() {
  StereoDepthResult result;
  result.stamp = header().stamp.toSec();
  result.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  result.corners = 321;
  result.points = {{next(), next(), next(), next(), true}, {next(), next(), next(), next(), false}};
  fill(result.plane.g);
  fill(result.plane.covariance);
  fill(result.row_covariance);
  fill(result.plane_rate);
  fill(result.plane_by_rate);
  fill(result.below.g);
  fill(result.below.covariance);
  result.curvature = next();
  result.curvature_variance = next();
  result.residual_stddev = next();
  result.surface_variance = next();
  result.from_search = true;
  result.skew = next();
  fill(result.vertical_rotation.w);
  fill(result.vertical_rotation.covariance);
  result.vertical_rotation.count = 99;
  fill(result.baseline_direction.t);
  fill(result.baseline_direction.covariance);
  result.disparity_bias_stddev = next();
  result.row_bias_stddev = next();
  result.lasting_share = next();
  result.row_agreement = next();
  result.photometric_agreement = next();
  result.right_repeated = true;
  return result;
}

ApproachAngleResult distinctApproachAngle() {
  ApproachAngleResult result;
  result.stamp = header().stamp.toSec();
  result.failure = {Reason::kMotionInconsistent, "3 of 40"};
  result.left = distinctView();
  result.right = distinctView();
  fill(result.vanishing_direction);
  fill(result.vanishing_covariance);
  result.other_runway_probability = next();
  fill(result.n_vp);
  fill(result.n_vp_covariance);
  fill(result.n);
  fill(result.n_covariance);
  result.step = distinctMotion();
  result.window = distinctMotion();
  fill(result.foe);
  fill(result.foe_covariance);
  result.readout = {next(), next()};
  fill(result.plane_by_turns.mean);
  fill(result.plane_by_turns.covariance);
  result.imu.failure = {Reason::kRejected, "off"};
  fill(result.imu.normal);
  fill(result.imu.normal_covariance);
  result.imu.duration = next();
  fill(result.imu.rotation);
  fill(result.imu.rotation_covariance);
  ApproachAngleResult::Sight& sight = result.sight;
  sight.failure = {Reason::kNoRunway, "no outline"};
  fill(sight.position);
  fill(sight.covariance);
  for (double* number :
       {&sight.yaw, &sight.yaw_variance, &sight.width, &sight.width_variance, &sight.length,
        &sight.length_variance, &sight.height_by_chart, &sight.disparity, &sight.disparity_variance,
        &sight.height_by_bias, &sight.size_over_chart, &sight.size_over_chart_variance})
    *number = next();
  fill(sight.height_without);
  fill(sight.variance_without);
  result.runway.failure = {Reason::kNotYet, "2 of 3"};
  result.runway.threshold_failure = {Reason::kNoRunway, "no bars"};
  for (double* number :
       {&result.runway.x, &result.runway.x_variance, &result.runway.y, &result.runway.y_variance,
        &result.runway.width, &result.runway.width_variance, &result.runway.x_systematic_variance})
    *number = next();
  for (CentreSolutions::Solution& solution : result.runway.y_without.without) solution = {next(), next()};
  return result;
}

LandingResult distinctLanding() {
  LandingResult result;
  result.stamp = header().stamp.toSec();
  result.status = Status::kCoasting;
  result.failure = {Reason::kRejected, "raw height 3 m"};
  result.yaw_failure = {Reason::kNoRunway, "another one"};
  result.height_valid = true;
  for (double* number : {&result.height,
                         &result.height_variance,
                         &result.raw_height,
                         &result.raw_height_variance,
                         &result.points_height,
                         &result.vertical_speed,
                         &result.vertical_speed_variance,
                         &result.approach_angle,
                         &result.approach_angle_variance,
                         &result.raw_approach_angle,
                         &result.raw_approach_angle_variance,
                         &result.pitch,
                         &result.pitch_variance,
                         &result.roll,
                         &result.roll_variance,
                         &result.yaw,
                         &result.yaw_variance,
                         &result.other_runway_probability,
                         &result.innovation,
                         &result.innovation_variance,
                         &result.x,
                         &result.x_variance,
                         &result.y,
                         &result.y_variance,
                         &result.y_protection_level,
                         &result.height_above_runway,
                         &result.height_above_runway_variance,
                         &result.height_above_runway_protection_level,
                         &result.height_above_runway_limit,
                         &result.runway_width,
                         &result.runway_width_variance,
                         &result.width_height,
                         &result.width_height_variance})
    *number = next();
  fill(result.foe);
  fill(result.velocity);
  fill(result.angular_velocity);
  fill(result.twist_covariance);
  result.rejected = true;
  result.consecutive_rejections = 3;
  result.resets = 2;
  fill(result.rig_rotation.w);
  fill(result.rig_rotation.covariance);
  result.height_protection_level = 0.4;
  result.height_alert_limit = 0.5;
  result.protection_source = "near_region";
  result.height_above_runway_known = true;
  result.height_origin = HeightOrigin::kGeometry;
  result.runway_failure = {Reason::kInconsistent, "1.1 times the chart's"};
  TestResult tilt;
  tilt.name = "tilt";
  tilt.difference = 2;
  tilt.variance = 0.25;
  tilt.ratio = 16;
  tilt.limit = 9;
  tilt.consecutive_failures = 3;
  result.tests = {tilt};
  return result;
}

TEST(Conversions, StereoDepthComesBackBitForBit) {
  const StereoDepthResult result = distinctStereoDepth();
  const StereoDepth message = toMessage(result, header(), 2.5);
  const StereoDepthResult back = toResult(message);

  EXPECT_EQ(message.compute_ms, 2.5);
  EXPECT_EQ(message.header.frame_id, "left_rect");
  EXPECT_EQ(back.stamp, result.stamp);
  EXPECT_EQ(back.failure.reason, Reason::kTooFewMatches);
  EXPECT_EQ(back.failure.message(), "too_few_matches: 7 of at least 20");
  EXPECT_EQ(back.corners, 321);
  ASSERT_EQ(back.points.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.points[i].u, result.points[i].u);
    EXPECT_EQ(back.points[i].v, result.points[i].v);
    EXPECT_EQ(back.points[i].disparity, result.points[i].disparity);
    EXPECT_EQ(back.points[i].disparity_stddev, result.points[i].disparity_stddev);
    EXPECT_EQ(back.points[i].on_plane, result.points[i].on_plane);
  }
  EXPECT_EQ(back.plane.g, result.plane.g);
  EXPECT_EQ(back.plane.covariance, result.plane.covariance);
  EXPECT_EQ(back.row_covariance, result.row_covariance);
  EXPECT_EQ(back.plane_rate, result.plane_rate);
  EXPECT_EQ(back.plane_by_rate, result.plane_by_rate);
  EXPECT_EQ(back.below.g, result.below.g);
  EXPECT_EQ(back.below.covariance, result.below.covariance);
  EXPECT_EQ(back.curvature, result.curvature);
  EXPECT_EQ(back.curvature_variance, result.curvature_variance);
  EXPECT_EQ(back.residual_stddev, result.residual_stddev);
  EXPECT_EQ(back.surface_variance, result.surface_variance);
  EXPECT_TRUE(back.from_search);
  EXPECT_EQ(back.skew, result.skew);
  EXPECT_EQ(back.vertical_rotation.w, result.vertical_rotation.w);
  EXPECT_EQ(back.vertical_rotation.covariance, result.vertical_rotation.covariance);
  EXPECT_EQ(back.vertical_rotation.count, 99);
  EXPECT_EQ(back.baseline_direction.t, result.baseline_direction.t);
  EXPECT_EQ(back.baseline_direction.covariance, result.baseline_direction.covariance);
  EXPECT_EQ(back.disparity_bias_stddev, result.disparity_bias_stddev);
  EXPECT_EQ(back.row_bias_stddev, result.row_bias_stddev);
  EXPECT_EQ(back.lasting_share, result.lasting_share);
  EXPECT_EQ(back.row_agreement, result.row_agreement);
  EXPECT_EQ(back.photometric_agreement, result.photometric_agreement);
  EXPECT_FALSE(back.left_repeated);
  EXPECT_TRUE(back.right_repeated);
}

TEST(Conversions, ATangentThatWasNeverFilledInIsNotKnown) {
  StereoDepth message;
  message.plane = {0, 0.5, 0};
  const StereoDepthResult result = toResult(message);
  EXPECT_TRUE(result.plane.valid());
  EXPECT_TRUE(result.below.g.array().isNaN().all());
}

TEST(Conversions, CovariancesAreRowMajorInMessages) {
  StereoDepthResult result;
  fill(result.plane.covariance);
  const StereoDepth message = toMessage(result, header(), 0);
  EXPECT_EQ(message.plane_covariance[1], result.plane.covariance(0, 1));
  EXPECT_EQ(message.plane_covariance[3], result.plane.covariance(1, 0));
}

TEST(Conversions, ApproachAngleComesBackBitForBit) {
  const ApproachAngleResult result = distinctApproachAngle();
  const ApproachAngleResult back = toResult(toMessage(result, header(), 1));

  EXPECT_EQ(back.stamp, result.stamp);
  EXPECT_EQ(back.failure.message(), result.failure.message());
  expectEqual(back.left, result.left);
  expectEqual(back.right, result.right);
  EXPECT_EQ(back.vanishing_direction, result.vanishing_direction);
  EXPECT_EQ(back.vanishing_covariance, result.vanishing_covariance);
  EXPECT_EQ(back.other_runway_probability, result.other_runway_probability);
  EXPECT_EQ(back.n_vp, result.n_vp);
  EXPECT_EQ(back.n_vp_covariance, result.n_vp_covariance);
  EXPECT_EQ(back.n, result.n);
  EXPECT_EQ(back.n_covariance, result.n_covariance);
  expectEqual(back.step, result.step);
  expectEqual(back.window, result.window);
  EXPECT_EQ(back.foe, result.foe);
  EXPECT_EQ(back.foe_covariance, result.foe_covariance);
  EXPECT_EQ(back.readout.time, result.readout.time);
  EXPECT_EQ(back.plane_by_turns.mean, result.plane_by_turns.mean);
  EXPECT_EQ(back.plane_by_turns.covariance, result.plane_by_turns.covariance);
  EXPECT_EQ(back.readout.variance, result.readout.variance);
  EXPECT_EQ(back.imu.failure.message(), result.imu.failure.message());
  EXPECT_EQ(back.imu.normal, result.imu.normal);
  EXPECT_EQ(back.imu.normal_covariance, result.imu.normal_covariance);
  EXPECT_EQ(back.imu.duration, result.imu.duration);
  EXPECT_EQ(back.imu.rotation, result.imu.rotation);
  EXPECT_EQ(back.imu.rotation_covariance, result.imu.rotation_covariance);
  EXPECT_EQ(back.runway.failure.message(), result.runway.failure.message());
  EXPECT_EQ(back.runway.threshold_failure.message(), result.runway.threshold_failure.message());
  EXPECT_EQ(back.runway.x, result.runway.x);
  EXPECT_EQ(back.runway.x_variance, result.runway.x_variance);
  EXPECT_EQ(back.runway.x_systematic_variance, result.runway.x_systematic_variance);
  EXPECT_EQ(back.runway.y, result.runway.y);
  EXPECT_EQ(back.runway.y_variance, result.runway.y_variance);
  for (int i = 0; i < kCentreSources; ++i) {
    EXPECT_EQ(back.runway.y_without.without[i].value, result.runway.y_without.without[i].value);
    EXPECT_EQ(back.runway.y_without.without[i].variance, result.runway.y_without.without[i].variance);
  }
  EXPECT_EQ(back.runway.width, result.runway.width);
  EXPECT_EQ(back.runway.width_variance, result.runway.width_variance);
}

TEST(Conversions, TheSightOfTheRunwayComesBackBitForBit) {
  const ApproachAngleResult result = distinctApproachAngle();
  const ApproachAngleResult::Sight &sight = result.sight,
                                   back = toResult(toMessage(result, header(), 1)).sight;
  EXPECT_EQ(back.failure.message(), sight.failure.message());
  EXPECT_EQ(back.position, sight.position);
  EXPECT_EQ(back.covariance, sight.covariance);
  EXPECT_EQ(back.yaw, sight.yaw);
  EXPECT_EQ(back.yaw_variance, sight.yaw_variance);
  EXPECT_EQ(back.width, sight.width);
  EXPECT_EQ(back.width_variance, sight.width_variance);
  EXPECT_EQ(back.length, sight.length);
  EXPECT_EQ(back.length_variance, sight.length_variance);
  EXPECT_EQ(back.height_without, sight.height_without);
  EXPECT_EQ(back.variance_without, sight.variance_without);
  EXPECT_EQ(back.height_by_chart, sight.height_by_chart);
  EXPECT_EQ(back.disparity, sight.disparity);
  EXPECT_EQ(back.disparity_variance, sight.disparity_variance);
  EXPECT_EQ(back.height_by_bias, sight.height_by_bias);
  EXPECT_EQ(back.size_over_chart, sight.size_over_chart);
  EXPECT_EQ(back.size_over_chart_variance, sight.size_over_chart_variance);
}

TEST(Conversions, LandingEstimateComesBackBitForBit) {
  const LandingResult result = distinctLanding();
  const LandingEstimate message = toMessage(result, header(), "base_link", 0.002, 3.5);
  // The message of what comes back shows every field once more.
  const LandingEstimate again = toMessage(toResult(message), header(), "base_link", 0.002, 3.5);

  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.status, LandingEstimate::COASTING);
  EXPECT_TRUE(message.height_valid);
  EXPECT_FALSE(message.valid) << "the angle is not valid";
  EXPECT_EQ(message.height, result.height);
  EXPECT_EQ(message.yaw_variance, result.yaw_variance);
  EXPECT_EQ(message.innovation_variance, result.innovation_variance);
  EXPECT_EQ(message.rig_rotation[2], result.rig_rotation.w.z());
  EXPECT_EQ(message.rig_rotation_covariance[1], result.rig_rotation.covariance(0, 1));
  EXPECT_EQ(message.twist_covariance[8], result.twist_covariance(1, 2));
  EXPECT_EQ(message.skew, 0.002);
  EXPECT_EQ(message.compute_ms, 3.5);
  EXPECT_TRUE(message.yaw_known);
  EXPECT_EQ(message.yaw_reason, "no_runway: another one");
  EXPECT_EQ(message.other_runway_probability, result.other_runway_probability);
  EXPECT_TRUE(message.x_known);
  EXPECT_TRUE(message.y_known);
  EXPECT_EQ(message.x, result.x);
  EXPECT_EQ(message.y_variance, result.y_variance);
  EXPECT_EQ(message.y_protection_level, result.y_protection_level);
  EXPECT_EQ(message.height_above_runway, result.height_above_runway);
  EXPECT_EQ(message.height_above_runway_variance, result.height_above_runway_variance);
  EXPECT_FALSE(toMessage(LandingResult(), header(), "base_link", 0, 0).x_known);
  EXPECT_EQ(message.height_protection_level, 0.4);
  EXPECT_EQ(message.height_alert_limit, 0.5);
  EXPECT_EQ(message.protection_source, "near_region");
  ASSERT_EQ(message.tests.size(), 1u);
  EXPECT_EQ(message.tests[0].name, "tilt");
  EXPECT_EQ(message.tests[0].ratio, 16);
  EXPECT_EQ(message.tests[0].consecutive_failures, 3u);
  EXPECT_TRUE(message.tests[0].failed);
  EXPECT_EQ(again, message);
}

// A field that is left out, or put into another one's place, in both directions comes back bit for bit all
// the same. So each field of a message is compared with what belongs there.
#define EXPECT_FIELD(message, result, field) EXPECT_EQ((message).field, (result).field) << #field

template <class Array, class Matrix>
void expectRowMajor(const Array& array, const Matrix& matrix, const char* field) {
  ASSERT_EQ(static_cast<Eigen::Index>(array.size()), matrix.size()) << field;
  for (int row = 0; row < matrix.rows(); ++row)
    for (int column = 0; column < matrix.cols(); ++column)
      EXPECT_EQ(array[row * matrix.cols() + column], matrix(row, column)) << field << " " << row << column;
}
#define EXPECT_ROW_MAJOR(message, result, field) expectRowMajor((message).field, (result).field, #field)

/// Every number has been given another value than all others: none was left out, and none copied twice.
template <class Message>
void expectAllDifferent(Message message) {
  std::vector<double> numbers;
  FieldVisitor visitor;
  visitor.on_number = [&](double& number) { numbers.push_back(number); };
  visitor.visit(message);
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end())
      << *std::adjacent_find(numbers.begin(), numbers.end()) << " stands in two fields";
  EXPECT_FALSE(std::binary_search(numbers.begin(), numbers.end(), 0.0)) << "a field was left out";
}

void expectFields(const ImageLines& message, const ApproachAngleResult::View& view) {
  EXPECT_EQ(message.reason, view.failure.message());
  ASSERT_EQ(message.lines.size(), view.lines.size());
  for (size_t i = 0; i < message.lines.size(); ++i) {
    EXPECT_EQ(message.lines[i].u1, view.lines[i].a.x());
    EXPECT_EQ(message.lines[i].v1, view.lines[i].a.y());
    EXPECT_EQ(message.lines[i].u2, view.lines[i].b.x());
    EXPECT_EQ(message.lines[i].v2, view.lines[i].b.y());
    EXPECT_EQ(message.lines[i].inlier, view.lines[i].inlier);
  }
  EXPECT_ROW_MAJOR(message, view, vanishing_direction);
  EXPECT_ROW_MAJOR(message, view, vanishing_covariance);
}

void expectFields(const Motion& message, const ApproachAngleResult::Motion& motion) {
  EXPECT_EQ(message.reason, motion.failure.message());
  EXPECT_FIELD(message, motion, duration);
  EXPECT_EQ(message.matches, 12u);
  EXPECT_EQ(message.inliers, 11u);
  EXPECT_ROW_MAJOR(message, motion, rotation);
  EXPECT_ROW_MAJOR(message, motion, translation_over_height);
  EXPECT_ROW_MAJOR(message, motion, covariance);
  EXPECT_EQ(message.approach_angle, motion.angle);
  EXPECT_EQ(message.approach_angle_variance, motion.angle_variance);
  EXPECT_FIELD(message, motion, row_motion);
  EXPECT_FIELD(message, motion, row_motion_limit);
  EXPECT_ROW_MAJOR(message, motion, normal);
  EXPECT_ROW_MAJOR(message, motion, normal_covariance);
}

TEST(Conversions, EachFieldOfStereoDepthHasItsOwnNumber) {
  const StereoDepthResult result = distinctStereoDepth();
  const StereoDepth message = toMessage(result, header(), next());
  EXPECT_EQ(message.reason, result.failure.message());
  EXPECT_EQ(message.corners, 321u);
  ASSERT_EQ(message.u.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(message.u[i], result.points[i].u);
    EXPECT_EQ(message.v[i], result.points[i].v);
    EXPECT_EQ(message.disparity[i], result.points[i].disparity);
    EXPECT_EQ(message.disparity_stddev[i], result.points[i].disparity_stddev);
    EXPECT_EQ(message.on_plane[i], i == 0 ? 1 : 0);
  }
  expectRowMajor(message.plane, result.plane.g, "plane");
  expectRowMajor(message.plane_covariance, result.plane.covariance, "plane_covariance");
  expectRowMajor(message.plane_row_covariance, result.row_covariance, "plane_row_covariance");
  expectRowMajor(message.plane_by_rate, result.plane_by_rate, "plane_by_rate");
  EXPECT_EQ(message.plane_lasting_share, result.lasting_share);
  expectRowMajor(message.plane_below, result.below.g, "plane_below");
  expectRowMajor(message.plane_below_covariance, result.below.covariance, "plane_below_covariance");
  EXPECT_EQ(message.surface_curvature, result.curvature);
  EXPECT_EQ(message.surface_curvature_variance, result.curvature_variance);
  EXPECT_FIELD(message, result, residual_stddev);
  EXPECT_FIELD(message, result, surface_variance);
  EXPECT_FIELD(message, result, disparity_bias_stddev);
  EXPECT_FIELD(message, result, row_bias_stddev);
  expectRowMajor(message.vertical_rotation, result.vertical_rotation.w, "vertical_rotation");
  expectRowMajor(message.vertical_rotation_covariance, result.vertical_rotation.covariance,
                 "vertical_rotation_covariance");
  EXPECT_EQ(message.vertical_rotation_count, 99u);
  expectRowMajor(message.baseline_direction, result.baseline_direction.t, "baseline_direction");
  expectRowMajor(message.baseline_direction_covariance, result.baseline_direction.covariance,
                 "baseline_direction_covariance");
  EXPECT_FIELD(message, result, row_agreement);
  EXPECT_FIELD(message, result, photometric_agreement);
  EXPECT_FIELD(message, result, skew);
  expectAllDifferent(message);
}

TEST(Conversions, EachFlagOfStereoDepthIsItsOwn) {
  for (int flag = 0; flag < 3; ++flag) {
    StereoDepthResult result;
    result.left_repeated = flag == 0;
    result.right_repeated = flag == 1;
    result.from_search = flag == 2;
    const StereoDepth message = toMessage(result, header(), 0);
    EXPECT_EQ(message.left_repeated, flag == 0);
    EXPECT_EQ(message.right_repeated, flag == 1);
    EXPECT_EQ(message.from_search, flag == 2);
    const StereoDepthResult back = toResult(message);
    EXPECT_EQ(back.left_repeated, flag == 0);
    EXPECT_EQ(back.right_repeated, flag == 1);
    EXPECT_EQ(back.from_search, flag == 2);
  }
}

TEST(Conversions, EachFieldOfApproachAngleHasItsOwnNumber) {
  const ApproachAngleResult result = distinctApproachAngle();
  const ApproachAngle message = toMessage(result, header(), next());
  EXPECT_EQ(message.reason, result.failure.message());
  expectFields(message.left, result.left);
  expectFields(message.right, result.right);
  EXPECT_ROW_MAJOR(message, result, vanishing_direction);
  EXPECT_ROW_MAJOR(message, result, vanishing_covariance);
  EXPECT_ROW_MAJOR(message, result, n_vp);
  EXPECT_ROW_MAJOR(message, result, n_vp_covariance);
  EXPECT_ROW_MAJOR(message, result, n);
  EXPECT_ROW_MAJOR(message, result, n_covariance);
  expectFields(message.step, result.step);
  expectFields(message.window, result.window);
  EXPECT_ROW_MAJOR(message, result, foe);
  EXPECT_ROW_MAJOR(message, result, foe_covariance);
  EXPECT_EQ(message.runway.reason, "not_yet: 2 of 3");
  EXPECT_EQ(message.runway.threshold_reason, "no_runway: no bars");
  EXPECT_FIELD(message.runway, result.runway, x);
  EXPECT_FIELD(message.runway, result.runway, x_variance);
  EXPECT_FIELD(message.runway, result.runway, x_systematic_variance);
  EXPECT_FIELD(message.runway, result.runway, y);
  EXPECT_FIELD(message.runway, result.runway, y_variance);
  EXPECT_EQ(message.runway.y_without[2], result.runway.y_without[CentreSource::kStripe].value);
  EXPECT_EQ(message.runway.y_variance_without[2], result.runway.y_without[CentreSource::kStripe].variance);
  EXPECT_FIELD(message.runway, result.runway, width);
  EXPECT_FIELD(message.runway, result.runway, width_variance);
  EXPECT_EQ(message.sight.reason, "no_runway: no outline");
  EXPECT_ROW_MAJOR(message.sight, result.sight, position);
  EXPECT_ROW_MAJOR(message.sight, result.sight, covariance);
  EXPECT_FIELD(message.sight, result.sight, yaw);
  EXPECT_FIELD(message.sight, result.sight, yaw_variance);
  EXPECT_FIELD(message.sight, result.sight, width);
  EXPECT_FIELD(message.sight, result.sight, width_variance);
  EXPECT_FIELD(message.sight, result.sight, length);
  EXPECT_FIELD(message.sight, result.sight, length_variance);
  EXPECT_ROW_MAJOR(message.sight, result.sight, height_without);
  EXPECT_ROW_MAJOR(message.sight, result.sight, variance_without);
  EXPECT_FIELD(message.sight, result.sight, height_by_chart);
  EXPECT_FIELD(message.sight, result.sight, disparity);
  EXPECT_FIELD(message.sight, result.sight, disparity_variance);
  EXPECT_FIELD(message.sight, result.sight, height_by_bias);
  EXPECT_FIELD(message.sight, result.sight, size_over_chart);
  EXPECT_FIELD(message.sight, result.sight, size_over_chart_variance);
  EXPECT_EQ(message.imu.reason, "rejected: off");
  EXPECT_ROW_MAJOR(message.imu, result.imu, normal);
  EXPECT_ROW_MAJOR(message.imu, result.imu, normal_covariance);
  EXPECT_FIELD(message.imu, result.imu, duration);
  EXPECT_ROW_MAJOR(message.imu, result.imu, rotation);
  EXPECT_ROW_MAJOR(message.imu, result.imu, rotation_covariance);
  expectAllDifferent(message);
}

TEST(Conversions, EachFieldOfALandingEstimateHasItsOwnNumber) {
  const LandingResult result = distinctLanding();
  const LandingEstimate message = toMessage(result, header(), "base_link", next(), next());
  EXPECT_EQ(message.reason, result.failure.message());
  EXPECT_FIELD(message, result, height);
  EXPECT_FIELD(message, result, height_variance);
  EXPECT_FIELD(message, result, raw_height);
  EXPECT_FIELD(message, result, raw_height_variance);
  EXPECT_FIELD(message, result, points_height);
  EXPECT_FIELD(message, result, vertical_speed);
  EXPECT_FIELD(message, result, vertical_speed_variance);
  EXPECT_FIELD(message, result, approach_angle);
  EXPECT_FIELD(message, result, approach_angle_variance);
  EXPECT_FIELD(message, result, raw_approach_angle);
  EXPECT_FIELD(message, result, raw_approach_angle_variance);
  EXPECT_FIELD(message, result, pitch);
  EXPECT_FIELD(message, result, pitch_variance);
  EXPECT_FIELD(message, result, roll);
  EXPECT_FIELD(message, result, roll_variance);
  EXPECT_FIELD(message, result, yaw);
  EXPECT_FIELD(message, result, yaw_variance);
  EXPECT_ROW_MAJOR(message, result, foe);
  EXPECT_ROW_MAJOR(message, result, velocity);
  EXPECT_ROW_MAJOR(message, result, angular_velocity);
  EXPECT_ROW_MAJOR(message, result, twist_covariance);
  EXPECT_FIELD(message, result, innovation);
  EXPECT_FIELD(message, result, innovation_variance);
  EXPECT_EQ(message.consecutive_rejections, 3u);
  EXPECT_EQ(message.resets, 2u);
  EXPECT_FIELD(message, result, x);
  EXPECT_FIELD(message, result, x_variance);
  EXPECT_FIELD(message, result, y);
  EXPECT_FIELD(message, result, y_variance);
  EXPECT_FIELD(message, result, y_protection_level);
  EXPECT_FIELD(message, result, height_above_runway);
  EXPECT_FIELD(message, result, height_above_runway_variance);
  EXPECT_FIELD(message, result, height_above_runway_protection_level);
  EXPECT_FIELD(message, result, height_above_runway_limit);
  EXPECT_EQ(message.height_origin, "geometry");
  EXPECT_EQ(message.runway_reason, "inconsistent: 1.1 times the chart's");
  EXPECT_EQ(toResult(message).height_origin, HeightOrigin::kGeometry);
  EXPECT_FIELD(message, result, runway_width);
  EXPECT_FIELD(message, result, runway_width_variance);
  EXPECT_FIELD(message, result, width_height);
  EXPECT_FIELD(message, result, width_height_variance);
  expectRowMajor(message.rig_rotation, result.rig_rotation.w, "rig_rotation");
  expectRowMajor(message.rig_rotation_covariance, result.rig_rotation.covariance, "rig_rotation_covariance");
  EXPECT_FIELD(message, result, height_protection_level);
  EXPECT_FIELD(message, result, height_alert_limit);
  EXPECT_FIELD(message, result, protection_source);
  ASSERT_EQ(message.tests.size(), 1u);
  EXPECT_FIELD(message.tests[0], result.tests[0], name);
  EXPECT_FIELD(message.tests[0], result.tests[0], difference);
  EXPECT_FIELD(message.tests[0], result.tests[0], variance);
  EXPECT_FIELD(message.tests[0], result.tests[0], ratio);
  EXPECT_FIELD(message.tests[0], result.tests[0], limit);
  EXPECT_EQ(message.tests[0].consecutive_failures, 3u);
  expectAllDifferent(message);
}

TEST(Conversions, EachFlagOfALandingEstimateIsItsOwn) {
  for (int flag = 0; flag < 8; ++flag) {
    LandingResult result;
    result.status = Status::kTracking;
    result.height_valid = flag == 0 || flag == 5;
    result.angle_valid = flag == 1 || flag == 5;
    result.rejected = flag == 2;
    if (flag == 3) result.x = -40;
    if (flag == 4) result.y = 3;
    if (flag == 6) result.yaw = 0.1;
    result.height_above_runway_known = flag == 7;
    const LandingEstimate message = toMessage(result, header(), "base_link", 0, 0);
    EXPECT_EQ(message.height_above_runway_known, flag == 7);
    EXPECT_EQ(toResult(message).height_above_runway_known, flag == 7);
    EXPECT_EQ(message.height_valid, result.height_valid) << flag;
    EXPECT_EQ(message.angle_valid, result.angle_valid) << flag;
    EXPECT_EQ(message.valid, flag == 5) << flag;
    EXPECT_EQ(message.rejected, flag == 2) << flag;
    EXPECT_EQ(message.x_known, flag == 3) << flag;
    EXPECT_EQ(message.y_known, flag == 4) << flag;
    EXPECT_EQ(message.yaw_known, flag == 6) << flag;
    const LandingResult back = toResult(message);
    EXPECT_EQ(back.height_valid, result.height_valid) << flag;
    EXPECT_EQ(back.angle_valid, result.angle_valid) << flag;
    EXPECT_EQ(back.rejected, flag == 2) << flag;
  }
}

TEST(Conversions, ATestFailsAboveItsLimitAlone) {
  TestResult test;
  test.limit = 9;
  for (const double ratio : {8.0, 10.0}) {
    test.ratio = ratio;
    EXPECT_EQ(toMessage(test).failed, ratio > 9);
  }
}

TEST(LandingMessages, PoseAndTwistHaveTheirNumbersAndCovariancesInPlace) {
  Matrix6d covariance;
  fill(covariance);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(-40, 3, 12);
  pose.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto pose_message = poseMessage(header(), pose, covariance);
  EXPECT_EQ(pose_message->header, header());
  EXPECT_EQ(pose_message->pose.pose.position.x, -40);
  EXPECT_EQ(pose_message->pose.pose.position.y, 3);
  EXPECT_EQ(pose_message->pose.pose.position.z, 12);
  EXPECT_NEAR(pose_message->pose.pose.orientation.z, std::sin(0.2), 1e-12);
  EXPECT_NEAR(pose_message->pose.pose.orientation.w, std::cos(0.2), 1e-12);
  expectRowMajor(pose_message->pose.covariance, covariance, "pose covariance");

  const auto twist = twistMessage(header().stamp, "base_link", {{1, 2, 3}, {4, 5, 6}, covariance});
  EXPECT_EQ(twist->header.stamp, header().stamp);
  EXPECT_EQ(twist->header.frame_id, "base_link");
  EXPECT_EQ(twist->twist.twist.linear.x, 1);
  EXPECT_EQ(twist->twist.twist.linear.y, 2);
  EXPECT_EQ(twist->twist.twist.linear.z, 3);
  EXPECT_EQ(twist->twist.twist.angular.x, 4);
  EXPECT_EQ(twist->twist.twist.angular.y, 5);
  EXPECT_EQ(twist->twist.twist.angular.z, 6);
  expectRowMajor(twist->twist.covariance, covariance, "twist covariance");
}

TEST(LandingMessages, ARangeIsTheHeightOnlyWhileThatIsValid) {
  LandingResult estimate;
  estimate.height = 12.5;
  estimate.raw_height = 13;
  EXPECT_TRUE(std::isnan(heightMessage(estimate, header().stamp, "base_link")->range));
  estimate.height_valid = true;
  const auto range = heightMessage(estimate, header().stamp, "base_link");
  EXPECT_EQ(range->range, 12.5F);
  EXPECT_EQ(range->header.stamp, header().stamp);
  EXPECT_EQ(range->header.frame_id, "base_link");
  EXPECT_EQ(range->min_range, 0);
  EXPECT_GE(range->max_range, 1000) << "drivers drop what is beyond";
}

TEST(Conversions, EveryReasonIsFoundByItsName) {
  for (int i = 0; i <= static_cast<int>(Reason::kRigBent); ++i) {
    const auto reason = static_cast<Reason>(i);
    EXPECT_EQ(parseFailure(toString(reason)).reason, reason);
  }
}

}  // namespace
