#include "conversions.h"

#include <gtest/gtest.h>

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
  fill(motion.covariance);
  motion.angle = next();
  motion.angle_variance = next();
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
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.angle_variance, b.angle_variance);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.normal_covariance, b.normal_covariance);
}

std_msgs::Header header() {
  std_msgs::Header header;
  header.stamp = ros::Time(1700000000, 123456789);
  header.frame_id = "left_rect";
  return header;
}

TEST(Conversions, StereoDepthComesBackBitForBit) {
  StereoDepthResult result;
  result.stamp = header().stamp.toSec();
  result.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  result.corners = 321;
  result.points = {{next(), next(), next(), next(), true}, {next(), next(), next(), next(), false}};
  fill(result.plane.g);
  fill(result.plane.covariance);
  fill(result.row_covariance);
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
  ApproachAngleResult result;
  result.stamp = header().stamp.toSec();
  result.failure = {Reason::kMotionInconsistent, "3 of 40"};
  result.left = distinctView();
  result.right = distinctView();
  fill(result.vanishing_direction);
  fill(result.vanishing_covariance);
  fill(result.n_vp);
  fill(result.n_vp_covariance);
  fill(result.n);
  fill(result.n_covariance);
  result.step = distinctMotion();
  result.window = distinctMotion();
  fill(result.foe);
  fill(result.foe_covariance);
  result.imu.failure = {Reason::kRejected, "off"};
  fill(result.imu.normal);
  fill(result.imu.normal_covariance);
  result.imu.duration = 0.1;
  fill(result.imu.rotation);
  fill(result.imu.rotation_covariance);
  result.runway.failure = {Reason::kNotYet, "2 of 3"};
  result.runway.threshold_failure = {Reason::kNoRunway, "no bars"};
  for (double* number :
       {&result.runway.x, &result.runway.x_variance, &result.runway.y, &result.runway.y_variance,
        &result.runway.width, &result.runway.width_variance, &result.runway.x_systematic_variance})
    *number = next();

  const ApproachAngleResult back = toResult(toMessage(result, header(), 1));

  EXPECT_EQ(back.stamp, result.stamp);
  EXPECT_EQ(back.failure.message(), result.failure.message());
  expectEqual(back.left, result.left);
  expectEqual(back.right, result.right);
  EXPECT_EQ(back.vanishing_direction, result.vanishing_direction);
  EXPECT_EQ(back.vanishing_covariance, result.vanishing_covariance);
  EXPECT_EQ(back.n_vp, result.n_vp);
  EXPECT_EQ(back.n_vp_covariance, result.n_vp_covariance);
  EXPECT_EQ(back.n, result.n);
  EXPECT_EQ(back.n_covariance, result.n_covariance);
  expectEqual(back.step, result.step);
  expectEqual(back.window, result.window);
  EXPECT_EQ(back.foe, result.foe);
  EXPECT_EQ(back.foe_covariance, result.foe_covariance);
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
  EXPECT_EQ(back.runway.width, result.runway.width);
  EXPECT_EQ(back.runway.width_variance, result.runway.width_variance);
}

TEST(Conversions, LandingEstimateComesBackBitForBit) {
  LandingResult result;
  result.stamp = header().stamp.toSec();
  result.status = Status::kCoasting;
  result.failure = {Reason::kRejected, "raw height 3 m"};
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
                         &result.innovation,
                         &result.innovation_variance,
                         &result.x,
                         &result.x_variance,
                         &result.y,
                         &result.y_variance,
                         &result.height_above_runway,
                         &result.height_above_runway_variance,
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
  TestResult tilt;
  tilt.name = "tilt";
  tilt.difference = 2;
  tilt.variance = 0.25;
  tilt.ratio = 16;
  tilt.limit = 9;
  tilt.consecutive_failures = 3;
  result.tests = {tilt};

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
  EXPECT_TRUE(message.x_known);
  EXPECT_TRUE(message.y_known);
  EXPECT_EQ(message.x, result.x);
  EXPECT_EQ(message.y_variance, result.y_variance);
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

TEST(Conversions, EveryReasonIsFoundByItsName) {
  for (int i = 0; i <= static_cast<int>(Reason::kRigBent); ++i) {
    const auto reason = static_cast<Reason>(i);
    EXPECT_EQ(parseFailure(toString(reason)).reason, reason);
  }
}

}  // namespace
