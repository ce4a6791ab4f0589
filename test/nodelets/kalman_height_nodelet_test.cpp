#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/Range.h>
#include <std_srvs/Empty.h>
#include <tf2_msgs/TFMessage.h>
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using uav_landing::ApproachAngle;
using uav_landing::LandingEstimate;
using uav_landing::StereoDepth;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A camera 2 m above the ground, looking 15 degrees down, that moves level and straight ahead at 1 m/s.
class KalmanHeightNodeletTest : public NodeletTest {
 protected:
  /// Without live, the age of the last pair does not count: a test may be stopped for a while.
  void start(bool live = false) {
    setParameter("kalman_height", "drop_frames", live);
    setParameter("kalman_height", "complaint_period", 0.2);
    load("kalman_height");
    ASSERT_TRUE(eventually([&] {
      return stereo_.getNumSubscribers() > 0 && approach_.getNumSubscribers() > 0 &&
             left_info_.getNumSubscribers() > 0 && right_info_.getNumSubscribers() > 0 &&
             estimates_.connected() && ranges_.connected() && poses_.connected() && twists_.connected() &&
             transforms_.connected() && static_.getNumSubscribers() > 0;
    }));
  }

  void publish(double t, bool known = true) {
    const ros::Time stamp = PairPublisher::stampOf(t);
    for (const bool right : {false, true}) {
      const auto info = scene_.info(right);
      info->header.stamp = stamp;
      const double c = std::cos(rectifying_pitch_), s = std::sin(rectifying_pitch_);
      info->R = {1, 0, 0, 0, c, -s, 0, s, c};
      info->header.frame_id = right ? "right_optical" : left_frame_;
      (right ? right_info_ : left_info_).publish(info);
    }
    const double h = 2, c = std::cos(scene_.pitch), s = std::sin(scene_.pitch);
    auto depth = boost::make_shared<StereoDepth>();
    depth->header.stamp = stamp;
    depth->header.frame_id = image_frame_;
    depth->row_agreement = kNan;
    depth->vertical_rotation.assign(kNan);
    depth->vertical_rotation_covariance.assign(kNan);
    depth->baseline_direction.assign(kNan);
    depth->baseline_direction_covariance.assign(kNan);
    auto angle = boost::make_shared<ApproachAngle>();
    angle->header = depth->header;
    angle->vanishing_direction.assign(kNan);
    angle->vanishing_covariance.assign(kNan);
    angle->n_vp.assign(kNan);
    angle->n_vp_covariance.assign(kNan);
    angle->foe.assign(kNan);
    angle->foe_covariance.assign(kNan);
    if (known) {
      depth->plane = {0, c / h, -s / h};
      fillDiagonal(depth->plane_covariance, 1e-8);
      angle->n = {0, c, -s};
      fillDiagonal(angle->n_covariance, 1e-8);
      // 0.1 m along the horizontal in 0.1 s.
      angle->step.duration = 0.1;
      angle->step.translation_over_height = {0, 0.1 / h * s, 0.1 / h * c};
      fillDiagonal(angle->step.covariance, 1e-8);
      angle->step.approach_angle = 0;
      angle->step.approach_angle_variance = 1e-6;
      angle->window = angle->step;
      if (std::isfinite(runway_width_)) {
        angle->runway.reason.clear();
        angle->runway.y = 0;
        angle->runway.y_variance = 1e-6;
        angle->runway.width = runway_width_;
        angle->runway.width_variance = 1e-6;
      }
    } else {
      depth->reason = "no_plane";
      angle->reason = angle->step.reason = angle->window.reason = "no_ground_normal";
      depth->plane.assign(kNan);
      depth->plane_covariance.assign(kNan);
      angle->n.assign(kNan);
      angle->n_covariance.assign(kNan);
    }
    stereo_.publish(depth);
    approach_.publish(angle);
  }
  template <class Array>
  static void fillDiagonal(Array& matrix, double value) {
    const auto size = static_cast<size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
    for (size_t i = 0; i < size; ++i) matrix[i * size + i] = value;
  }

  /// Publishes pairs of every 0.1 s until their estimates have come. The first two heights wait for
  /// confirmation.
  void publishSome(double from, int count) {
    for (int i = 0; i < count; ++i) {
      publish(from + 0.1 * i);
      ASSERT_TRUE(waitFor(from + 0.1 * i));
    }
  }
  bool waitFor(double t) {
    return estimates_.waitFor([t](const auto& e) { return e.header.stamp == PairPublisher::stampOf(t); });
  }
  LandingEstimate estimateOf(double t) const {
    for (const auto& estimate : estimates_.messages())
      if (estimate->header.stamp == PairPublisher::stampOf(t)) return *estimate;
    return LandingEstimate();
  }

  /// A camera 1 m ahead of and 0.5 m below base_link, looking straight ahead (not pitched itself).
  void publishLeverArm(const std::string& parent, const std::string& child) {
    // Forward-left-up to right-down-forward.
    static_.publish(mounting(parent, child, {1, 0, -0.5}, {0.5, -0.5, 0.5, -0.5}));
  }
  static tf2_msgs::TFMessage mounting(const std::string& parent, const std::string& child,
                                      const Eigen::Vector3d& arm, const Eigen::Quaterniond& rotation) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    auto& transform = message.transforms[0];
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.translation.x = arm.x();
    transform.transform.translation.y = arm.y();
    transform.transform.translation.z = arm.z();
    transform.transform.rotation.w = rotation.w();
    transform.transform.rotation.x = rotation.x();
    transform.transform.rotation.y = rotation.y();
    transform.transform.rotation.z = rotation.z();
    return message;
  }

  /// With base_frame, a static transform from it to left_optical, and pairs until that has arrived. Nothing
  /// is valid and nothing but the estimate and its range is published; the reason is the one given.
  void expectNotValid(const std::string& base_frame, const Eigen::Quaterniond& rotation,
                      const std::string& reason) {
    setParameter("kalman_height", "base_frame", base_frame);
    start();
    static_.publish(mounting(base_frame, "left_optical", {0, 0, -1}, rotation));
    double t = 0;
    ASSERT_TRUE(eventually([&] {
      publish(t += 0.1);
      return waitFor(t) && estimateOf(t).reason == reason;
    })) << estimateOf(t).reason;
    publishSome(t + 0.1, 4);
    const LandingEstimate estimate = estimateOf(t + 0.4);
    EXPECT_EQ(estimate.reason, reason);
    EXPECT_EQ(estimate.child_frame_id, base_frame);
    EXPECT_FALSE(estimate.valid || estimate.height_valid || estimate.angle_valid);
    EXPECT_FALSE(estimate.x_known || estimate.y_known);
    EXPECT_TRUE(logged("kalman_height: no valid estimate for 0.2 s: " + reason)) << wholeLog();
    for (const auto& range : ranges_.messages()) EXPECT_TRUE(std::isnan(range->range));
    EXPECT_TRUE(transforms_.messages().empty() && poses_.messages().empty() && twists_.messages().empty());
  }

  /// Pairs until the log and the diagnostics have said so, with valid estimates all the same.
  void expectComplaint(const std::string& complaint) {
    Listener<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
    const auto said = [&] {
      for (const auto& array : diagnostics.messages())
        for (const auto& status : array->status)
          if (status.message == complaint) return status.level == diagnostic_msgs::DiagnosticStatus::WARN;
      return false;
    };
    double t = 0;
    EXPECT_TRUE(eventually([&] {
      publish(t += 0.1);
      return waitFor(t) && estimateOf(t).valid && said();
    }));
    EXPECT_TRUE(logged("/uav_landing/kalman_height: " + complaint)) << wholeLog();
  }

  StereoScene scene_;
  double runway_width_ = kNan;                                              // as seen, over the height
  std::string left_frame_ = "left_optical", image_frame_ = "left_optical";  // frame_ids
  double rectifying_pitch_ = 0;  // rad, of R in camera_info: from the camera as mounted to the rectified one
  ros::Publisher stereo_ = handle_.advertise<StereoDepth>("/uav_landing/stereo_depth", 100);
  ros::Publisher approach_ = handle_.advertise<ApproachAngle>("/uav_landing/approach_angle", 100);
  ros::Publisher left_info_ =
      handle_.advertise<sensor_msgs::CameraInfo>("/uav_landing/left/camera_info", 100);
  ros::Publisher right_info_ =
      handle_.advertise<sensor_msgs::CameraInfo>("/uav_landing/right/camera_info", 100);
  ros::Publisher static_ = handle_.advertise<tf2_msgs::TFMessage>("/tf_static", 100, true);
  Listener<LandingEstimate> estimates_{"/uav_landing/landing_estimate"};
  Listener<sensor_msgs::Range> ranges_{"/uav_landing/height"};
  Listener<geometry_msgs::PoseWithCovarianceStamped> poses_{"/uav_landing/pose"};
  Listener<geometry_msgs::TwistWithCovarianceStamped> twists_{"/uav_landing/twist"};
  Listener<tf2_msgs::TFMessage> transforms_{"/tf"};
};

constexpr char kNoOpticalFrame[] =
    " deg: the frame_id of camera_info must be an optical frame (z forward, x right, y down), in static tf "
    "left_optical is not";

TEST_F(KalmanHeightNodeletTest, PublishesEstimateRangePoseAndTransformOfTheImageStamp) {
  start();
  publishSome(0, 5);
  const LandingEstimate estimate = estimateOf(0.4);
  EXPECT_EQ(estimate.reason, "");
  EXPECT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.status, LandingEstimate::TRACKING);
  EXPECT_EQ(estimate.header.frame_id, "runway");
  EXPECT_EQ(estimate.child_frame_id, "left_optical_rect");
  EXPECT_NEAR(estimate.height, 2, 0.01);
  EXPECT_NEAR(estimate.pitch, scene_.pitch, 1e-3);
  EXPECT_FALSE(estimate.x_known);
  EXPECT_FALSE(estimate.y_known);

  // Between slow pairs there may be one that says that the height is lost.
  ASSERT_TRUE(ranges_.waitFor([](const auto& range) {
    return range.header.stamp == PairPublisher::stampOf(0.4) && std::abs(range.range - 2) < 0.01;
  }));
  EXPECT_TRUE(std::isnan(ranges_.messages()[0]->range)) << "not confirmed yet";

  ASSERT_TRUE(transforms_.waitFor(
      [](const auto& m) { return m.transforms[0].header.stamp == PairPublisher::stampOf(0.4); }));
  const auto transform = transforms_.messages().back()->transforms[0];
  EXPECT_EQ(transform.header.frame_id, "runway");
  EXPECT_EQ(transform.child_frame_id, "left_optical_rect");
  EXPECT_NEAR(transform.transform.translation.z, 2, 0.01);
  // 1 m/s for the 0.2 s since the first valid estimate.
  const auto poses = poses_.messages();
  EXPECT_NEAR(poses.back()->pose.pose.position.x - poses.front()->pose.pose.position.x,
              (poses.back()->header.stamp - poses.front()->header.stamp).toSec(), 0.01);
  EXPECT_GE(poses.back()->pose.covariance[0], 1e6) << "the place along the runway is not known";
  EXPECT_NEAR(poses.back()->pose.covariance[14], estimate.height_variance, 1e-9);
  // In the camera's axes, which look 15 degrees down.
  ASSERT_TRUE(twists_.waitFor([](const auto& m) { return m.header.stamp == PairPublisher::stampOf(0.4); }));
  EXPECT_LE(twists_.messages().size(), poses.size()) << "not before the height is valid";
  const auto twist = *twists_.messages().back();
  EXPECT_EQ(twist.header.frame_id, "left_optical_rect");
  EXPECT_NEAR(twist.twist.twist.linear.z, std::cos(scene_.pitch), 0.01);
  EXPECT_EQ(twist.twist.twist.linear.z, estimate.velocity[2]);
  EXPECT_GT(twist.twist.covariance[14], estimate.twist_covariance[14]) << "half a step later";
}

TEST_F(KalmanHeightNodeletTest, FailedPairsHaveTheirMessagesButNoTransform) {
  start();
  for (int i = 0; i < 4; ++i) publish(0.1 * i, false);
  ASSERT_TRUE(waitFor(0.3));
  ASSERT_TRUE(ranges_.waitFor(4));
  const LandingEstimate estimate = estimateOf(0.3);
  EXPECT_EQ(estimate.status, LandingEstimate::SEARCHING);
  EXPECT_FALSE(estimate.valid);
  EXPECT_EQ(estimate.reason, "no_plane");
  EXPECT_TRUE(std::isnan(estimate.height));
  for (const auto& range : ranges_.messages()) EXPECT_TRUE(std::isnan(range->range));
  EXPECT_TRUE(transforms_.messages().empty());
  EXPECT_TRUE(poses_.messages().empty());
}

TEST_F(KalmanHeightNodeletTest, OneTransformPerStampAlsoAfterAJumpBackInTime) {
  start();
  publishSome(10, 5);
  estimates_.clear();
  publishSome(0, 5);
  ASSERT_TRUE(transforms_.waitFor(
      [](const auto& m) { return m.transforms[0].header.stamp == PairPublisher::stampOf(0.4); }));
  std::vector<ros::Time> stamps;
  for (const auto& message : transforms_.messages()) stamps.push_back(message->transforms[0].header.stamp);
  std::sort(stamps.begin(), stamps.end());
  EXPECT_EQ(std::adjacent_find(stamps.begin(), stamps.end()), stamps.end());
  EXPECT_TRUE(estimateOf(0.4).valid);
}

TEST_F(KalmanHeightNodeletTest, WithoutPairsItIsLost) {
  start(true);
  ASSERT_TRUE(estimates_.waitFor([](const auto& e) { return e.status == LandingEstimate::LOST; }));
  publishSome(0, 5);
  EXPECT_TRUE(estimateOf(0.4).valid);
  estimates_.clear();
  ASSERT_TRUE(estimates_.waitFor([](const auto& e) { return e.status == LandingEstimate::LOST; }));
  const LandingEstimate lost = *estimates_.messages().back();
  EXPECT_FALSE(lost.valid);
  EXPECT_EQ(lost.reason.rfind("timeout", 0), 0u) << lost.reason;
  EXPECT_TRUE(std::isnan(lost.height));
  EXPECT_GT(lost.header.stamp, PairPublisher::stampOf(0.4)) << "in the clock of the images";
  EXPECT_LT(lost.header.stamp, PairPublisher::stampOf(0.4) + ros::Duration(60));
}

TEST_F(KalmanHeightNodeletTest, IsNotLostBeforeAPairHasHadItsTimeToCome) {
  constexpr double kMaxAge = 2;
  setParameter("kalman_height", "max_age", kMaxAge);
  const ros::WallTime begin = ros::WallTime::now();
  start(true);
  ASSERT_TRUE(estimates_.waitFor(1));
  EXPECT_GE((ros::WallTime::now() - begin).toSec(), kMaxAge);
}

TEST_F(KalmanHeightNodeletTest, LostAfterAResetItHasHadPairsAllTheSame) {
  start(true);
  publishSome(0, 3);
  std_srvs::Empty nothing;
  ASSERT_TRUE(ros::service::call("/uav_landing/kalman_height/reset", nothing));
  estimates_.clear();
  ASSERT_TRUE(estimates_.waitFor([](const auto& e) { return e.status == LandingEstimate::LOST; }));
  EXPECT_EQ(estimates_.messages().back()->reason, "timeout: no image pair any more");
}

TEST_F(KalmanHeightNodeletTest, WhenNothingIsDroppedRecordedPairsDoNotGrowOld) {
  setParameter("kalman_height", "max_age", 0.05);
  start();
  // The complaint comes later than several times max_age.
  ASSERT_TRUE(logged("/uav_landing/kalman_height: nothing to work on"));
  EXPECT_TRUE(estimates_.messages().empty());
}

TEST_F(KalmanHeightNodeletTest, BaseLinkOfTheStaticTfIsEstimatedWithItsLeverArm) {
  start();
  publishLeverArm("base_link", "left_optical");
  // Until the transform has arrived, the camera itself is estimated.
  double t = 0;
  ASSERT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).child_frame_id == "base_link" && estimateOf(t).valid;
  }));
  // The aircraft is pitched by -15 degrees: the camera, 1 m ahead and 0.5 m below, is lower by
  // 1 m sin 15 + 0.5 m cos 15.
  EXPECT_NEAR(estimateOf(t).height, 2 + std::sin(15 * M_PI / 180) + 0.5 * std::cos(15 * M_PI / 180), 0.02);
  ASSERT_TRUE(
      transforms_.waitFor([](const auto& m) { return m.transforms[0].child_frame_id == "base_link"; }));
  const auto transform = transforms_.messages().back()->transforms[0].transform;
  EXPECT_NEAR(transform.translation.z, estimateOf(t).height, 0.05);
  // Nose down by 15 degrees is a positive rotation about y (left).
  EXPECT_NEAR(transform.rotation.y, std::sin(7.5 * M_PI / 180), 1e-3);
  EXPECT_NEAR(transform.rotation.w, std::cos(7.5 * M_PI / 180), 1e-3);
  // Level flight at 1 m/s, in the axes of an aircraft whose nose is 15 degrees down.
  publishSome(t + 0.1, 4);  // a velocity is believed after three steps
  ASSERT_TRUE(twists_.waitFor([](const auto& m) { return m.header.frame_id == "base_link"; }));
  const auto linear = twists_.messages().back()->twist.twist.linear;
  EXPECT_NEAR(linear.x, std::cos(15 * M_PI / 180), 0.02);
  EXPECT_NEAR(linear.y, 0, 1e-9);
  EXPECT_NEAR(linear.z, std::sin(15 * M_PI / 180), 0.02);
}

TEST_F(KalmanHeightNodeletTest, TheRotationOfRectificationTurnsTheLeverArm) {
  rectifying_pitch_ = 10 * M_PI / 180;
  start();
  publishLeverArm("base_link", "left_optical");
  double t = 0;
  ASSERT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).child_frame_id == "base_link" && estimateOf(t).valid;
  }));
  // The rectified camera looks 15 degrees down. R turns forward (z) towards up (-y): the mounted camera's
  // axis lies 10 degrees above the rectified one's, so the aircraft is pitched by -5 degrees only.
  EXPECT_NEAR(estimateOf(t).height, 2 + std::sin(5 * M_PI / 180) + 0.5 * std::cos(5 * M_PI / 180), 0.02);
}

TEST_F(KalmanHeightNodeletTest, ACameraOneMetreBelowBaseLinkIsThatMuchLower) {
  setParameter("kalman_height", "base_frame", std::string("base_link"));
  scene_.pitch = -2 * M_PI / 180;
  start();
  static_.publish(mounting("base_link", "left_optical", {0, 0, -1}, {0.5, -0.5, 0.5, -0.5}));
  double t = 0;
  ASSERT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).valid;
  })) << estimateOf(t).reason;
  EXPECT_EQ(estimateOf(t).child_frame_id, "base_link");
  EXPECT_NEAR(estimateOf(t).height, 2 + 1, 0.005);
}

// The camera looks 15 degrees down. Its z axis is taken for forward, so base_link's up axis is where that is.
TEST_F(KalmanHeightNodeletTest, ABodyFrameAsFrameIdIsNotValid) {
  expectNotValid("base_link", {1, 0, 0, 0},
                 std::string("transform_invalid: base_link is tilted by 105") + kNoOpticalFrame);
}

TEST_F(KalmanHeightNodeletTest, AForwardRightDownFrameAsFrameIdIsNotValid) {
  expectNotValid("base_link", {0, 1, 0, 0},
                 std::string("transform_invalid: base_link is tilted by 75") + kNoOpticalFrame);
}

TEST_F(KalmanHeightNodeletTest, ABaseFrameAndAFrameIdThatAreForwardRightDownAreNotValid) {
  expectNotValid("base_link_frd", {1, 0, 0, 0},
                 std::string("transform_invalid: base_link_frd is tilted by 105") + kNoOpticalFrame);
}

TEST_F(KalmanHeightNodeletTest, ABaseFrameThatIsForwardRightDownIsNotValid) {
  expectNotValid(
      "base_link_frd", {0.5, 0.5, 0.5, 0.5},
      "transform_invalid: base_link_frd is tilted by 165 deg: its z axis must be up (x forward, y left), "
      "and the frame_id of camera_info an optical frame (z forward, x right, y down)");
}

TEST_F(KalmanHeightNodeletTest, AWrongFrameIsToldBeforeTheGroundIsSeen) {
  setParameter("kalman_height", "base_frame", std::string("base_link"));
  start();
  static_.publish(mounting("base_link", "left_optical", {0, 0, -1}, {1, 0, 0, 0}));
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    publish(t += 0.1, false);
    return waitFor(t) && estimateOf(t).reason ==
                             std::string("transform_invalid: base_link is tilted by 90") + kNoOpticalFrame;
  })) << estimateOf(t).reason;
}

TEST_F(KalmanHeightNodeletTest, ACameraThatCallsItselfBaseLinkIsNotValid) {
  left_frame_ = image_frame_ = "base_link";
  start();
  publishSome(0, 5);
  EXPECT_FALSE(estimateOf(0.4).valid);
  EXPECT_EQ(estimateOf(0.4).reason,
            "transform_invalid: base_link is tilted by 105 deg: the frame_id of camera_info must be an "
            "optical frame (z forward, x right, y down), in static tf base_link is not");
  EXPECT_TRUE(transforms_.messages().empty());
}

TEST_F(KalmanHeightNodeletTest, ACameraInfoThatCannotBeUsedIsToldBeforeItsFrame) {
  setParameter("kalman_height", "base_frame", std::string("base_link"));
  start();
  static_.publish(mounting("base_link", "left_optical", {0, 0, -1}, {1, 0, 0, 0}));
  scene_.baseline = 0;
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).reason.rfind("input_invalid: camera_info: right P[3]", 0) == 0;
  })) << estimateOf(t).reason;
}

TEST_F(KalmanHeightNodeletTest, ATransformOnTfInsteadOfTfStaticIsNotValid) {
  const std::string reason =
      "transform_missing: base_link -> left_optical is on /tf, only /tf_static is used for the rig";
  const ros::Publisher moving = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10, true);
  setParameter("kalman_height", "base_frame", std::string("base_link"));
  start();
  moving.publish(mounting("base_link", "left_optical", {0, 0, -1}, {0.5, -0.5, 0.5, -0.5}));
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).reason == reason;
  })) << estimateOf(t).reason;
  EXPECT_TRUE(logged("kalman_height: no valid estimate for 0.2 s: " + reason)) << wholeLog();
}

TEST_F(KalmanHeightNodeletTest, ATransformOnTfInsteadOfTfStaticIsToldWhenNoneWasAskedFor) {
  const ros::Publisher moving = handle_.advertise<tf2_msgs::TFMessage>("/tf", 10, true);
  setParameter("kalman_height", "diagnostic_period", 0.2);
  start();
  moving.publish(mounting("base_link", "left_optical", {0, 0, -1}, {0.5, -0.5, 0.5, -0.5}));
  expectComplaint(
      "base_link -> left_optical is on /tf, only /tf_static is used for the rig: the left camera is "
      "estimated");
  EXPECT_EQ(estimates_.messages().back()->child_frame_id, "left_optical_rect");
}

TEST_F(KalmanHeightNodeletTest, AnEmptyFrameIdIsToldAndHasNoTransform) {
  left_frame_ = image_frame_ = "";
  setParameter("kalman_height", "diagnostic_period", 0.2);
  start();
  expectComplaint("the frame_id of the left camera_info is empty: the left camera is estimated");
  EXPECT_EQ(estimates_.messages().back()->child_frame_id, "");
  EXPECT_NEAR(estimates_.messages().back()->height, 2, 0.01);
  EXPECT_TRUE(transforms_.messages().empty());
}

TEST_F(KalmanHeightNodeletTest, AnEmptyFrameIdOfTheImageIsTold) {
  image_frame_ = "";
  setParameter("kalman_height", "diagnostic_period", 0.2);
  start();
  expectComplaint("the frame_id of the left image is empty, that of its camera_info is used");
  EXPECT_EQ(estimates_.messages().back()->child_frame_id, "left_optical_rect");
}

TEST_F(KalmanHeightNodeletTest, AnEmptyFrameIdHasNoLeverArm) {
  left_frame_ = "";
  setParameter("kalman_height", "base_frame", std::string("base_link"));
  start();
  publishSome(0, 5);
  EXPECT_FALSE(estimateOf(0.4).valid);
  EXPECT_EQ(estimateOf(0.4).reason, "transform_missing: the frame_id of the left camera_info is empty");
}

TEST_F(KalmanHeightNodeletTest, AConfiguredBaseFrameThatIsUnknownIsNotValid) {
  setParameter("kalman_height", "base_frame", std::string("imu_link"));
  start();
  publishSome(0, 5);
  const LandingEstimate estimate = estimateOf(0.4);
  EXPECT_FALSE(estimate.valid);
  EXPECT_FALSE(estimate.height_valid);
  EXPECT_EQ(estimate.reason, "transform_missing: no static transform between imu_link and left_optical");
  EXPECT_TRUE(std::isnan(estimate.velocity[2])) << "as the height is not valid";
  EXPECT_TRUE(transforms_.messages().empty());
  publishLeverArm("imu_link", "left_optical");
  double t = 0.4;
  EXPECT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && estimateOf(t).valid;
  }));
  EXPECT_EQ(estimateOf(t).child_frame_id, "imu_link");
  EXPECT_NEAR(estimateOf(t).velocity[2], std::cos(scene_.pitch), 0.01);
}

TEST_F(KalmanHeightNodeletTest, DiagnosticsSayWhyWhatIsPublishedIsNotValid) {
  setParameter("kalman_height", "base_frame", std::string("imu_link"));
  setParameter("kalman_height", "diagnostic_period", 0.2);
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  start();
  const auto said = [&] {
    for (const auto& array : diagnostics.messages())
      for (const auto& status : array->status)
        if (status.message.rfind("transform_missing: ", 0) == 0)
          return status.level == diagnostic_msgs::DiagnosticStatus::WARN;
    return false;
  };
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    publish(t += 0.1);
    return waitFor(t) && said();
  }));
}

TEST_F(KalmanHeightNodeletTest, ABadRigIsTheReasonOfEveryMessage) {
  start();
  scene_.baseline = 0;
  publish(0);
  ASSERT_TRUE(waitFor(0));
  EXPECT_EQ(estimateOf(0).reason.rfind("input_invalid: camera_info: right P[3]", 0), 0u)
      << estimateOf(0).reason;
  EXPECT_FALSE(estimateOf(0).valid);
  EXPECT_TRUE(std::isnan(estimateOf(0).height));
}

TEST_F(KalmanHeightNodeletTest, APairThatCannotBeUsedDoesNotBeginThePathAnew) {
  start();
  publishSome(0, 5);
  ASSERT_TRUE(poses_.waitFor(1));
  const double begin = poses_.messages().front()->pose.pose.position.x;
  const auto stamp = poses_.messages().front()->header.stamp;
  const double baseline = scene_.baseline;
  scene_.baseline = 0;
  publish(0.5);
  ASSERT_TRUE(waitFor(0.5));
  scene_.baseline = baseline;
  publishSome(0.6, 5);
  ASSERT_TRUE(poses_.waitFor([](const auto& p) { return p.header.stamp == PairPublisher::stampOf(1.0); }));
  const auto last = poses_.messages().back();
  // At 1 m/s all the time, but for the velocity that is not seen where the pair is the first again.
  EXPECT_NEAR(last->pose.pose.position.x - begin, (last->header.stamp - stamp).toSec(), 0.25);
  EXPECT_GT(last->pose.pose.position.x - begin, 0.7);
}

TEST_F(KalmanHeightNodeletTest, TheServiceResetForgetsTheHeight) {
  start();
  publishSome(0, 5);
  ASSERT_TRUE(estimateOf(0.4).valid);
  std_srvs::Empty nothing;
  ASSERT_TRUE(ros::service::call("/uav_landing/kalman_height/reset", nothing));
  publish(0.5);
  ASSERT_TRUE(waitFor(0.5));
  EXPECT_FALSE(estimateOf(0.5).valid) << "confirmed by nothing yet, like a first height";
  EXPECT_EQ(estimateOf(0.5).reason.rfind("not_yet", 0), 0u) << estimateOf(0.5).reason;
  publishSome(0.6, 3);
  EXPECT_TRUE(estimateOf(0.8).valid);
}

TEST_F(KalmanHeightNodeletTest, AMessageThatWasNeverFilledInHasItsEstimateAndChangesNothing) {
  start();
  publishSome(0, 5);
  auto depth = boost::make_shared<StereoDepth>();
  depth->header.stamp = PairPublisher::stampOf(0.5);
  depth->u.resize(3);  // and nothing else
  auto angle = boost::make_shared<ApproachAngle>();
  angle->header = depth->header;
  for (const bool right : {false, true}) {
    const auto info = scene_.info(right);
    info->header.stamp = depth->header.stamp;
    (right ? right_info_ : left_info_).publish(info);
  }
  stereo_.publish(depth);
  approach_.publish(angle);
  ASSERT_TRUE(waitFor(0.5));
  EXPECT_FALSE(estimateOf(0.5).valid);
  publishSome(0.6, 4);
  const LandingEstimate after = estimateOf(0.9);
  EXPECT_TRUE(after.valid) << after.reason;
  EXPECT_NEAR(after.height, 2, 0.01);
}

TEST_F(KalmanHeightNodeletTest, MarkersAreFiniteAndTheirViewFollows) {
  Listener<visualization_msgs::MarkerArray> markers("/uav_landing/markers");
  setParameter("kalman_height", "publish_tf", false);
  start();
  ASSERT_TRUE(eventually([&] { return markers.connected(); }));
  publishSome(0, 5);
  publish(0.5, false);
  ASSERT_TRUE(waitFor(0.5));
  ASSERT_TRUE(markers.waitFor(6));
  for (const auto& array : markers.messages()) {
    EXPECT_GE(array->markers.size(), 5u);
    for (const auto& marker : array->markers) {
      EXPECT_EQ(marker.header.frame_id, "runway");
      EXPECT_TRUE(std::isfinite(marker.pose.position.z));
      for (const auto& point : marker.points)
        EXPECT_TRUE(std::isfinite(point.x + point.y + point.z)) << marker.ns;
    }
  }
  ASSERT_TRUE(transforms_.waitFor(6));
  std::vector<double> x;
  for (const auto& message : transforms_.messages()) {
    ASSERT_EQ(message->transforms.size(), 1u);
    EXPECT_EQ(message->transforms[0].header.frame_id, "runway");
    EXPECT_EQ(message->transforms[0].child_frame_id, "landing_view") << "publish_tf is about the aircraft";
    x.push_back(message->transforms[0].transform.translation.x);
  }
  EXPECT_NEAR(x[4] - x[3], 0.1, 0.01) << "as the aircraft moves";
}

/// How wide the runway is drawn, m.
double drawnWidth(const visualization_msgs::MarkerArray& array) {
  double least = 0, most = 0;
  for (const auto& marker : array.markers)
    if (marker.ns == "runway")
      for (const auto& point : marker.points) {
        least = std::min(least, point.y);
        most = std::max(most, point.y);
      }
  return most - least;
}

TEST_F(KalmanHeightNodeletTest, TheRunwayIsDrawnAsWideAsItIsKnownToBe) {
  const auto expectDrawn = [&](double width) {
    Listener<visualization_msgs::MarkerArray> markers("/uav_landing/markers");
    start();
    ASSERT_TRUE(eventually([&] { return markers.connected(); }));
    publish(0);
    ASSERT_TRUE(markers.waitFor(1));
    EXPECT_NEAR(drawnWidth(*markers.messages()[0]), width, 0.01);
    unload("kalman_height");
  };
  expectDrawn(30);
  setParameter("runway", "width", 45);
  expectDrawn(45);
  setParameter("kalman_height", "drawn_runway_width", 20);
  expectDrawn(20);
}

TEST_F(KalmanHeightNodeletTest, TheRunwaysWidthGivesASecondHeight) {
  setParameter("runway", "width", 45);
  setParameter("runway", "side_stripe_inset", 0.01);  // so that the edges which show are the chart's
  start();
  runway_width_ = 45 / 2.02;  // over the height, as from 2.02 m
  publishSome(0, 4);
  EXPECT_NEAR(estimateOf(0.3).width_height, 2.02, 1e-3);
}

TEST_F(KalmanHeightNodeletTest, TheViewBeforeAnyImageDoesNotOutlastTheFirst) {
  Listener<visualization_msgs::MarkerArray> markers("/uav_landing/markers");
  start(true);
  ASSERT_TRUE(markers.waitFor(1));
  ASSERT_TRUE(transforms_.waitFor(1));
  EXPECT_EQ(transforms_.messages()[0]->transforms[0].child_frame_id, "landing_view");
  EXPECT_LT(transforms_.messages()[0]->transforms[0].header.stamp, ros::Time(1));
}

TEST_F(KalmanHeightNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("kalman_height", "gate", 0.5);
  expectRefusal("kalman_height", "kalman_height/gate: 0.5 is out of range, expected 1 to 20 sigma");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("kalman_height_nodelet_test")
