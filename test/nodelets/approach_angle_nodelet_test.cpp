#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/StereoDepth.h>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using uav_landing::ApproachAngle;
using uav_landing::StereoDepth;

namespace {

class ApproachAngleNodeletTest : public NodeletTest {
 protected:
  void start(bool with_stereo = true) {
    setParameter("approach_angle", "complaint_period", 0.2);
    load("approach_angle");
    output_ = std::make_unique<Listener<ApproachAngle>>("/uav_landing/approach_angle");
    ASSERT_TRUE(eventually([&] {
      return images_.connected() && output_->connected() && (!with_stereo || stereo_.getNumSubscribers() > 0);
    }));
  }

  /// The plane of the scene and points on it, as stereo would see them.
  void publishStereo(double t, bool known = true) {
    auto depth = boost::make_shared<StereoDepth>();
    depth->header.stamp = PairPublisher::stampOf(t);
    depth->header.frame_id = "left_optical";
    const double h = scene_.heightAt(t), nan = std::nan("");
    depth->plane = {0, std::cos(scene_.pitch) / h, -std::sin(scene_.pitch) / h};
    const double variance = 1e-8;
    depth->plane_covariance = {variance, 0, 0, 0, variance, 0, 0, 0, variance};
    for (double v = 0.5 * scene_.height; known && v < scene_.height - 20; v += 10) {
      for (double u = 40; u < scene_.width - 20; u += 10) {
        const double down = (v - 0.5 * scene_.height) / scene_.f * depth->plane[1] + depth->plane[2];
        depth->u.push_back(u);
        depth->v.push_back(v);
        depth->disparity.push_back(scene_.f * scene_.baseline * down);
        depth->disparity_stddev.push_back(0.1);
        depth->on_plane.push_back(1);
      }
    }
    if (!known) {
      depth->reason = "no_plane";
      depth->plane = {nan, nan, nan};
      depth->plane_covariance.assign(nan);
    }
    stereo_.publish(depth);
  }

  /// One pair, from t seconds after the start of the scene.
  void publishPair(double t) {
    publishStereo(t);
    images_.publish(scene_, t);
  }

  StereoScene scene_;
  PairPublisher images_{PairPublisher::kRectified};
  ros::Publisher stereo_ = handle_.advertise<StereoDepth>("/uav_landing/stereo_depth", 100);
  std::unique_ptr<Listener<ApproachAngle>> output_;
};

TEST_F(ApproachAngleNodeletTest, SubscribesOnlyWhileSomebodyListens) {
  load("approach_angle");
  EXPECT_TRUE(images_.unconnected());
  {
    Listener<ApproachAngle> listener("/uav_landing/approach_angle");
    EXPECT_TRUE(eventually([&] { return images_.connected() && stereo_.getNumSubscribers() > 0; }));
  }
  EXPECT_TRUE(eventually([&] { return images_.unconnected() && stereo_.getNumSubscribers() == 0; }));
}

TEST_F(ApproachAngleNodeletTest, FindsTheAngleOfTheDescent) {
  start();
  for (int i = 0; i < 5; ++i) {
    publishStereo(0.1 * i);
    images_.publish(scene_, 0.1 * i);
  }
  ASSERT_TRUE(output_->waitFor(5));
  const auto angles = output_->messages();
  EXPECT_NE(angles[0]->reason, "") << "one image has no motion";
  EXPECT_EQ(angles[4]->reason, "");
  EXPECT_EQ(angles[4]->header.stamp, PairPublisher::stampOf(0.4));
  EXPECT_NEAR(angles[4]->window.approach_angle, scene_.approach_angle, 0.5 * M_PI / 180);
}

TEST_F(ApproachAngleNodeletTest, BlackImagesHaveTheirMessageToo) {
  start();
  for (int i = 0; i < 3; ++i) {
    publishStereo(0.1 * i, false);
    images_.publishUniform(scene_, 0.1 * i, 0);
  }
  ASSERT_TRUE(output_->waitFor(3));
  for (const auto& angle : output_->messages()) {
    EXPECT_NE(angle->reason, "");
    EXPECT_TRUE(std::isnan(angle->window.approach_angle));
  }
}

TEST_F(ApproachAngleNodeletTest, WaitsForTheStereoResultOfTheSamePair) {
  start();
  images_.publish(scene_, 0);
  publishStereo(0.1);
  images_.publish(scene_, 0.1);
  ASSERT_TRUE(output_->waitFor(1));
  EXPECT_EQ(output_->messages()[0]->header.stamp, PairPublisher::stampOf(0.1));
}

TEST_F(ApproachAngleNodeletTest, MissingStereoIsNamed) {
  start();
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    images_.publishUniform(scene_, t += 0.1, 0);
    return wholeLog().find("no message on /uav_landing/stereo_depth") != std::string::npos;
  })) << wholeLog();
}

TEST_F(ApproachAngleNodeletTest, ComplainsOfNothingBeforeItHasWaitedForIt) {
  setParameter("approach_angle", "complaint_period", 0.5);
  setParameter("approach_angle", "diagnostic_period", 0.5);
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  load("approach_angle");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const ros::Time subscribed = ros::Time::now();
  const Listener<ApproachAngle> listener("/uav_landing/approach_angle");
  const std::string complaint = "nothing to work on for 0.5 s";
  ASSERT_TRUE(logged(complaint)) << wholeLog();
  for (const auto& line : log_.messages()) {
    if (line->msg.find(complaint) != std::string::npos) {
      EXPECT_GE((line->header.stamp - subscribed).toSec(), 0.5) << line->msg;
    }
  }
  EXPECT_TRUE(diagnostics.waitFor(
      [&](const auto& array) { return array.status[0].level == diagnostic_msgs::DiagnosticStatus::ERROR; }));
  for (const auto& array : diagnostics.messages()) {
    if (array->status[0].level == diagnostic_msgs::DiagnosticStatus::ERROR) {
      EXPECT_GE((array->header.stamp - subscribed).toSec(), 0.5) << array->status[0].message;
    }
  }
}

TEST_F(ApproachAngleNodeletTest, RunsWithoutStereoWhenToldTo) {
  setParameter("approach_angle", "use_stereo", false);
  start(false);
  EXPECT_EQ(stereo_.getNumSubscribers(), 0u);
  images_.publish(scene_, 0);
  EXPECT_TRUE(output_->waitFor(1));
}

TEST_F(ApproachAngleNodeletTest, GoesOnAfterAJumpBackInTime) {
  start();
  for (const double t : {10.0, 10.1, 0.0, 0.1, 0.2}) {
    publishStereo(t);
    images_.publish(scene_, t);
    // One after another: the jump must not overtake what was sent before.
    ASSERT_TRUE(output_->waitFor([t](const auto& a) { return a.header.stamp == PairPublisher::stampOf(t); }));
  }
  EXPECT_EQ(output_->messages().back()->reason, "");
}

/// An inertial sensor on the scene's level, straight flying aircraft.
class ImuTest : public ApproachAngleNodeletTest {
 protected:
  /// imu_wait of a second: no message comes too late on a machine that is busy.
  void startWithImu(double imu_wait = 1) {
    setParameter("approach_angle", "imu_wait", imu_wait);
    start();
    ASSERT_TRUE(eventually([&] { return imu_.getNumSubscribers() > 0; }));
  }
  void publishMounting(const std::string& child) {
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.frame_id = "left_optical";
    message.transforms[0].child_frame_id = child;
    // Forward, left, up in the optical frame.
    message.transforms[0].transform.rotation.x = 0.5;
    message.transforms[0].transform.rotation.y = -0.5;
    message.transforms[0].transform.rotation.z = 0.5;
    message.transforms[0].transform.rotation.w = 0.5;
    tf_.publish(message);
    ASSERT_TRUE(eventually([&] { return tf_.getNumSubscribers() > 0; }));
  }
  sensor_msgs::Imu message(double t) const {
    sensor_msgs::Imu message;
    message.header.stamp = PairPublisher::stampOf(t);
    message.header.frame_id = "imu_link";
    // Nose down is positive.
    message.orientation.y = std::sin(-0.5 * scene_.pitch);
    message.orientation.w = std::cos(-0.5 * scene_.pitch);
    message.linear_acceleration_covariance[0] = -1;
    return message;
  }
  void publishImu(double from, double to, double period = 0.01) {
    for (int i = 0; i <= std::lround((to - from) / period); ++i) imu_.publish(message(from + period * i));
  }
  /// Whether the diagnostics had this value, or one that begins with it.
  bool said(const std::string& key, const std::string& beginning) const {
    for (const auto& array : diagnostics_.messages())
      for (const auto& status : array->status)
        for (const auto& value : status.values)
          if (value.key == key && value.value.rfind(beginning, 0) == 0) return true;
    return false;
  }
  ApproachAngle resultOf(double t) {
    EXPECT_TRUE(output_->waitFor([t](const auto& a) { return a.header.stamp == PairPublisher::stampOf(t); }));
    for (const auto& result : output_->messages())
      if (result->header.stamp == PairPublisher::stampOf(t)) return *result;
    return {};
  }
  /// Until a pair's result has this property, ever new pairs, t further on.
  bool sooner(double& t, const std::function<bool(const ApproachAngle&)>& property) {
    return eventually([&] {
      t += 0.02;
      publishImu(t - 0.02, t);
      publishPair(t);
      return property(resultOf(t));
    });
  }

  ros::Publisher imu_ = handle_.advertise<sensor_msgs::Imu>("/imu/data", 1000);
  ros::Publisher tf_ = handle_.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{"/diagnostics"};
};

TEST_F(ImuTest, DiagnosticsSayWhatItIsUsedFor) {
  setParameter("approach_angle", "diagnostic_period", 0.2);
  startWithImu();
  EXPECT_TRUE(eventually([&] { return said("imu", "no pair yet"); }));
  EXPECT_FALSE(said("imu", "used"));
  publishMounting("imu_link");
  double t = 0;
  ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); })) << wholeLog();
  EXPECT_TRUE(eventually([&] { return said("imu", "used"); }));
  EXPECT_TRUE(eventually([&] {
    for (int i = 1; i <= 3; ++i) {
      sensor_msgs::Imu gyro = message(t + 0.01 * i);
      gyro.orientation_covariance[0] = -1;
      imu_.publish(gyro);
    }
    publishPair(t += 0.02);
    return resultOf(t).imu.reason.empty() || said("imu", "rotation only: ");
  })) << wholeLog();
  EXPECT_TRUE(eventually([&] { return said("imu", "rotation only: "); }));
}

TEST_F(ImuTest, DiagnosticsSayWhetherItTellsTheTurnsBetweenRows) {
  constexpr double kReadout = 0.01;  // s
  setParameter("approach_angle", "diagnostic_period", 0.2);
  setParameter("rig", "readout_time", kReadout);
  startWithImu();
  publishMounting("imu_link");
  double t = 0;
  const auto saidAfterPairs = [&](double period, const std::string& beginning) {
    return eventually([&] {
      publishImu(t, t + 0.02 + kReadout, period);
      publishPair(t += 0.02);
      resultOf(t);
      return said("imu within images", beginning);
    });
  };
  EXPECT_TRUE(
      saidAfterPairs(0.01, "timeout: the imu's messages are up to 10 ms apart while rows are exposed"));
  EXPECT_FALSE(said("imu within images", "used"));
  EXPECT_TRUE(saidAfterPairs(0.0025, "used"));
}

TEST_F(ImuTest, GivesTheNormalAndTheRotationOfEachPair) {
  startWithImu();
  publishMounting("imu_link");
  double t = 0;
  ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); })) << wholeLog();
  publishImu(t, t + 0.1);
  publishPair(t + 0.1);
  const ApproachAngle result = resultOf(t + 0.1);
  EXPECT_EQ(result.imu.reason, "");
  EXPECT_NEAR(result.imu.normal[1], std::cos(scene_.pitch), 1e-6);
  EXPECT_NEAR(result.imu.normal[2], -std::sin(scene_.pitch), 1e-6);
  EXPECT_NEAR(result.imu.duration, 0.1, 1e-6);
  EXPECT_NEAR(result.imu.rotation[0], 0, 1e-9);
}

TEST_F(ImuTest, APairWaitsForTheMessageAfterIt) {
  setParameter("approach_angle", "drop_frames", false);  // half a second of patience
  startWithImu();
  publishMounting("imu_link");
  double t = 0;
  ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); }));
  // Again where this test, stopped in between, tries the nodelet's patience.
  EXPECT_TRUE(eventually([&] {
    publishPair(t + 0.2);
    publishImu(t + 0.01, t + 0.21);
    t += 0.2;
    return resultOf(t).imu.reason.empty();
  })) << wholeLog();
}

TEST_F(ImuTest, ALateSensorHoldsNoPairUp) {
  startWithImu(0.02);
  publishMounting("imu_link");
  double t = 0;
  ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); }));
  publishPair(t + 0.3);
  const ApproachAngle late = resultOf(t + 0.3);
  EXPECT_EQ(late.imu.reason.find("timeout: the newest imu message is 0.3"), 0u) << late.imu.reason;
  // No pair waits until a message of the sensor has come again.
  publishImu(t + 0.01, t + 0.4);
  t += 0.4;
  EXPECT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); })) << wholeLog();
}

TEST_F(ImuTest, ASensorThatFallsSilentAgainHoldsNoPairUpEither) {
  startWithImu(0.02);
  publishMounting("imu_link");
  double t = 0;
  for (int time = 0; time < 3; ++time) {
    ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); })) << wholeLog();
    // Nothing else comes that could let it go.
    publishPair(t += 0.3);
    EXPECT_EQ(resultOf(t).imu.reason.find("timeout: the newest imu message is 0.3"), 0u) << time;
    publishImu(t - 0.29, t);
  }
}

TEST_F(ImuTest, AMissingTransformIsNamedAndTheAngleIsFoundWithoutIt) {
  startWithImu();
  publishMounting("another_imu");
  double t = 0;
  const std::string missing = "no static transform between the imu's imu_link and left_optical";
  EXPECT_TRUE(sooner(t, [&](const auto& result) {
    return result.imu.reason == "transform_missing: " + missing && result.reason.empty();
  }));
  EXPECT_TRUE(logged("/imu/data is not used for 0.2 s: transform_missing: " + missing)) << wholeLog();
}

TEST_F(ImuTest, NumbersThatAreNoneAreNamedAndLeftOut) {
  startWithImu();
  publishMounting("imu_link");
  double t = 0;
  ASSERT_TRUE(sooner(t, [](const auto& result) { return result.imu.reason.empty(); }));
  for (int i = 1; i <= 10; ++i) {
    sensor_msgs::Imu bad = message(t + 0.01 * i);
    bad.orientation.x = std::nan("");
    bad.angular_velocity.z = std::nan("");
    imu_.publish(bad);
  }
  EXPECT_TRUE(logged("/imu/data: angular_velocity: expected at most 100 rad/s, got 0, 0, nan")) << wholeLog();
  publishImu(t + 0.11, t + 0.3);
  publishPair(t + 0.3);
  EXPECT_EQ(resultOf(t + 0.3).imu.reason, "");
}

TEST_F(ImuTest, IsLeftAloneWhenToldTo) {
  setParameter("approach_angle", "use_imu", false);
  start();
  publishPair(0);
  EXPECT_EQ(resultOf(0).imu.reason, "not_yet: no imu message");
  EXPECT_EQ(imu_.getNumSubscribers(), 0u);
}

TEST_F(ApproachAngleNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("approach_angle", "angle_window", -1);
  expectRefusal("approach_angle", "approach_angle/angle_window: -1 is out of range");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("approach_angle_nodelet_test")
