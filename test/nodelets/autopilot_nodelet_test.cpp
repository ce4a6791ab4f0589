#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/Range.h>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"

using namespace uav_landing::test;
using geometry_msgs::PoseWithCovarianceStamped;
using geometry_msgs::TwistWithCovarianceStamped;
using sensor_msgs::Range;

namespace {

class AutopilotNodeletTest : public NodeletTest {
 protected:
  void start(double heading_deg = 90) {
    setParameter("autopilot", "runway_heading_deg", heading_deg);
    load("autopilot");
    ASSERT_TRUE(eventually([&] {
      return height_.getNumSubscribers() > 0 && pose_.getNumSubscribers() > 0 &&
             twist_.getNumSubscribers() > 0 && ranges_.connected() && poses_.connected() &&
             velocities_.connected();
    }));
  }

  /// What kalman_height says at a time; without a pose when there is no height.
  /// tilt: of the frame that is estimated, rad.
  void publish(double t, double height, double position_variance = 1, double tilt = 0) {
    Range range;
    range.header.stamp = ros::Time(1000 + t);
    range.header.frame_id = "base_link";
    range.range = static_cast<float>(height);
    height_.publish(range);
    if (!std::isfinite(height)) return;
    PoseWithCovarianceStamped pose;
    pose.header.stamp = range.header.stamp;
    pose.header.frame_id = "runway";
    pose.pose.pose.position.z = height;
    pose.pose.pose.orientation.x = std::sin(tilt / 2);
    pose.pose.pose.orientation.w = std::cos(tilt / 2);
    for (int i = 0; i < 6; ++i) pose.pose.covariance[7 * i] = i < 2 ? position_variance : 1e-4;
    pose.pose.covariance[35] = yaw_variance_;
    pose_.publish(pose);
  }

  /// Forward at 20 m/s.
  void publishMovement(double t) {
    TwistWithCovarianceStamped twist;
    twist.header.stamp = ros::Time(1000 + t);
    twist.header.frame_id = "base_link";
    twist.twist.twist.linear.x = 20;
    for (int i = 0; i < 6; ++i) twist.twist.covariance[7 * i] = 1e-2;
    twist_.publish(twist);
  }

  double yaw_variance_ = 1e-4;  // rad^2
  ros::Publisher height_ = handle_.advertise<Range>("/uav_landing/height", 1000);
  ros::Publisher pose_ = handle_.advertise<PoseWithCovarianceStamped>("/uav_landing/pose", 1000);
  ros::Publisher twist_ = handle_.advertise<TwistWithCovarianceStamped>("/uav_landing/twist", 1000);
  Listener<Range> ranges_{"/uav_landing/autopilot/range"};
  Listener<PoseWithCovarianceStamped> poses_{"/uav_landing/autopilot/pose"};
  Listener<TwistWithCovarianceStamped> velocities_{"/uav_landing/autopilot/velocity"};
};

TEST_F(AutopilotNodeletTest, PassesOnOnlyPairsWithAHeight) {
  start();
  publish(0.0, std::numeric_limits<double>::quiet_NaN());
  publish(0.1, 5);
  publish(0.2, std::numeric_limits<double>::quiet_NaN());
  publish(0.3, 4);
  ASSERT_TRUE(ranges_.waitFor(2) && poses_.waitFor(2));
  EXPECT_EQ(ranges_.messages()[0]->header.stamp, ros::Time(1000.1));
  EXPECT_EQ(ranges_.messages()[1]->header.stamp, ros::Time(1000.3));
  EXPECT_FLOAT_EQ(ranges_.messages()[1]->range, 4);
  EXPECT_EQ(poses_.messages()[0]->header.frame_id, "map");
}

TEST_F(AutopilotNodeletTest, SendsTheVelocityOfPairsThatHaveAMotion) {
  start(0);
  publish(0.1, 5);
  publish(0.2, 5);
  publishMovement(0.2);
  publishMovement(0.3);
  publish(0.3, 5, 1e6);
  ASSERT_TRUE(velocities_.waitFor(2) && ranges_.waitFor(3));
  EXPECT_EQ(velocities_.messages()[0]->header.stamp, ros::Time(1000.2));
  EXPECT_EQ(velocities_.messages()[1]->header.stamp, ros::Time(1000.3)) << "the place need not be known";
  EXPECT_EQ(velocities_.messages()[0]->header.frame_id, "map");
  EXPECT_NEAR(velocities_.messages()[0]->twist.twist.linear.y, 20, 1e-9) << "to the north";
}

TEST_F(AutopilotNodeletTest, SaysWhyNoVelocityIsSent) {
  setParameter("autopilot", "complaint_period", 0.2);
  start();
  yaw_variance_ = M_PI * M_PI;
  publish(0, 5);
  publishMovement(0);
  EXPECT_TRUE(
      logged("/uav_landing/autopilot: no velocity sent for 0.2 s: the runway's direction is not seen"))
      << wholeLog();
  EXPECT_TRUE(velocities_.messages().empty());
}

TEST_F(AutopilotNodeletTest, SendsTheRangeAloneOfARunwayWhoseHeadingItWasNotTold) {
  start(-1);
  publish(0.1, 5);
  publish(0.2, 4);
  publish(0.3, 3);
  ASSERT_TRUE(ranges_.waitFor(3));
  EXPECT_TRUE(poses_.messages().empty());
  EXPECT_TRUE(logged("sends the range alone, no pose and no velocity: runway_heading_deg is not set"))
      << wholeLog();
}

TEST_F(AutopilotNodeletTest, SendsNoMoreThanMaxRate) {
  setParameter("autopilot", "max_rate", 30.0);
  start();
  // No more at once than the queues hold.
  for (int i = 0; i <= 16; ++i) publish(i / 60.0, 5);
  const ros::Time last(1000 + 16 / 60.0);
  ASSERT_TRUE(ranges_.waitFor([&](const Range& range) { return range.header.stamp == last; }));
  EXPECT_EQ(ranges_.messages().size(), 9u) << "every second one of 60 Hz";
  EXPECT_TRUE(poses_.waitFor(9));
}

TEST_F(AutopilotNodeletTest, SendsTheRangeAloneBeforeTheRunwayIsFound) {
  start();
  publish(0, 5, 1e6);
  publish(0.1, 5, 1);
  ASSERT_TRUE(ranges_.waitFor(2) && poses_.waitFor(1));
  EXPECT_EQ(poses_.messages()[0]->header.stamp, ros::Time(1000.1));
}

TEST_F(AutopilotNodeletTest, SaysWhyNothingIsSentWhenACameraIsEstimated) {
  setParameter("autopilot", "complaint_period", 0.2);
  start();
  // The axes of a camera that looks along the runway: z is forward.
  publish(0, 5, 1, -M_PI / 2);
  EXPECT_TRUE(
      logged("/uav_landing/autopilot: nothing sent for 0.2 s: no range: what is estimated is tilted by 90 "
             "deg, as a camera is"))
      << wholeLog();
  EXPECT_TRUE(ranges_.messages().empty() && poses_.messages().empty());
}

TEST_F(AutopilotNodeletTest, DynamicReconfigureChangesParametersInFlight) {
  setParameter("autopilot", "max_rate", 20.0);
  Listener<dynamic_reconfigure::ConfigDescription> descriptions(
      "/uav_landing/autopilot/parameter_descriptions");
  Listener<dynamic_reconfigure::Config> updates("/uav_landing/autopilot/parameter_updates");
  start();
  ASSERT_TRUE(descriptions.waitFor(1));
  const auto& group = descriptions.messages()[0]->groups.at(0);
  ASSERT_EQ(group.parameters.size(), 5u);
  EXPECT_EQ(group.parameters[0].name, "max_range");
  EXPECT_EQ(group.parameters[0].type, "double");
  EXPECT_EQ(descriptions.messages()[0]->max.doubles.at(0).value, 655);
  // What the parameter server gave is told at once.
  ASSERT_TRUE(updates.waitFor(1));
  EXPECT_EQ(updates.messages()[0]->doubles.at(1).value, 20);

  dynamic_reconfigure::Reconfigure request;
  request.request.config.doubles.resize(2);
  request.request.config.doubles[0].name = "max_range";
  request.request.config.doubles[0].value = 4.5;
  request.request.config.doubles[1].name = "runway_heading_deg";
  request.request.config.doubles[1].value = 400;
  ASSERT_TRUE(ros::service::call("/uav_landing/autopilot/set_parameters", request));
  EXPECT_EQ(request.response.config.doubles.at(0).value, 4.5);
  EXPECT_EQ(request.response.config.doubles.at(1).value, 20) << "not asked for";
  EXPECT_EQ(request.response.config.doubles.at(3).value, 360) << "the nearest that is in range";
  EXPECT_TRUE(logged("runway_heading_deg: 400 is out of range, expected -1 to 360 deg; 360 is used"))
      << wholeLog();
  publish(0, 5);
  publish(0.1, 4);
  ASSERT_TRUE(ranges_.waitFor(1));
  EXPECT_FLOAT_EQ(ranges_.messages()[0]->range, 4) << "5 m is more than the new max_range";
}

TEST_F(AutopilotNodeletTest, RefusesARangeThatTheMessageCannotHold) {
  setParameter("autopilot", "max_range", 1000.0);
  expectRefusal("autopilot", "autopilot/max_range: 1000 is out of range, expected 1 to 655 m");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("autopilot_nodelet_test")
