// What happens to topics in the field: after each of these the chain is right again within a second of good
// input.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using uav_landing::ApproachAngle;
using uav_landing::LandingEstimate;
using uav_landing::StereoDepth;

namespace {

constexpr double kStep = 0.05;  // s between pairs
constexpr const char* kNodelets[] = {"rectify", "stereo_depth", "approach_angle", "kalman_height"};

template <class Message>
void ignore(const boost::shared_ptr<const Message>&) {}

class AbuseTest : public NodeletTest {
 protected:
  void SetUp() override {
    // A test that is stopped for a while must not make the height grow old.
    setParameter("kalman_height", "drop_frames", false);
    for (const char* nodelet : kNodelets) {
      setParameter(nodelet, "diagnostic_period", 0.2);
      load(nodelet);
    }
    expectRecovery(0);
  }

  /// Feeds good pairs, stamped from this time on, each when the one before has its estimate. The estimate
  /// must be valid and right before a second of them is over.
  void expectRecovery(double from) { expectRecovery(from, scene_); }
  void expectRecovery(double from, const StereoScene& scene) {
    ASSERT_TRUE(eventually([&] { return cameras_->connected() && estimates_.connected(); }));
    ASSERT_TRUE(eventually([&] { return chainIsConnected(); }));
    for (int i = 0; i <= 20; ++i) {
      const double t = kStep * i;
      const ros::Time stamp = PairPublisher::stampOf(from + t);
      estimates_.clear();
      cameras_->publishLeft(stamp, scene.image(t, false), scene.info(false));
      cameras_->publishRight(stamp, scene.image(t, true), scene.info(true));
      const auto of_pair = [&](const LandingEstimate& e) { return e.header.stamp == stamp; };
      // A pair on its way may have been left out; the next one is not.
      if (!eventually([&] { return has(of_pair); }, std::chrono::seconds(2))) continue;
      for (const auto& estimate : estimates_.messages()) {
        if (!of_pair(*estimate)) continue;
        last_reason_ = estimate->reason;
        if (!estimate->valid) continue;
        EXPECT_NEAR(estimate->height, scene.heightAt(t), 0.05);
        EXPECT_NEAR(estimate->approach_angle, scene.approach_angle, 0.02);
        return;
      }
    }
    FAIL() << "not valid after a second of good pairs: " << last_reason_;
  }

  bool has(const std::function<bool(const LandingEstimate&)>& property) const {
    for (const auto& estimate : estimates_.messages())
      if (property(*estimate)) return true;
    return false;
  }

  /// Every stage hears the one before, as the master says.
  static bool chainIsConnected() {
    XmlRpc::XmlRpcValue arguments, response, state;
    arguments[0] = ros::this_node::getName();
    if (!ros::master::execute("getSystemState", arguments, response, state, false)) return false;
    XmlRpc::XmlRpcValue& subscribed = state[1];  // of topics and their subscribers
    int found = 0;
    for (int i = 0; i < subscribed.size(); ++i) {
      const std::string topic = subscribed[i][0];
      found += topic == "/uav_landing/stereo_depth" || topic == "/uav_landing/approach_angle" ||
               topic == "/uav_landing/left/image_rect" || topic == "/uav_landing/right/time_reference";
    }
    return found == 4;
  }

  /// Whether any value of the diagnostics has this property.
  static bool diagnosticsSay(const std::function<bool(const diagnostic_msgs::KeyValue&)>& property) {
    Listener<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
    return diagnostics.waitFor([&](const diagnostic_msgs::DiagnosticArray& array) {
      for (const auto& status : array.status)
        for (const auto& value : status.values)
          if (property(value)) return true;
      return false;
    });
  }
  /// Of messages of the left camera, as "..., 3 dropped"; 0 where the value is of something else.
  static int leftDropped(const diagnostic_msgs::KeyValue& value) {
    const size_t dropped = value.value.rfind(" dropped");
    if (value.key != "/stereo/left/image_raw" || dropped == std::string::npos) return 0;
    return std::stoi(value.value.substr(value.value.rfind(", ", dropped) + 2));
  }

  StereoScene scene_;
  std::unique_ptr<PairPublisher> cameras_ = std::make_unique<PairPublisher>(PairPublisher::kRaw);
  Listener<LandingEstimate> estimates_{"/uav_landing/landing_estimate"};
  std::string last_reason_;
};

TEST_F(AbuseTest, APublisherThatRestarts) {
  for (int i = 1; i <= 3; ++i) {
    cameras_.reset();
    cameras_ = std::make_unique<PairPublisher>(PairPublisher::kRaw);
    expectRecovery(10.0 * i);
  }
}

TEST_F(AbuseTest, CamerasThatAreExchanged) {
  StereoScene other = scene_;
  other.f = 300;
  other.baseline = 0.4;
  expectRecovery(10, other);
  other.width = 400;
  other.height = 300;
  expectRecovery(20, other);
  expectRecovery(30);
}

TEST_F(AbuseTest, AClockThatJumpsAheadAndBack) {
  expectRecovery(5000);
  expectRecovery(1000000);
  expectRecovery(0);
  expectRecovery(-500);
}

TEST_F(AbuseTest, PairsThatComeLateAreLeftOutAndCountedAndTheHeightStays) {
  for (int i = 0; i <= 40; ++i) {
    const double t = kStep * i;
    const auto publish = [&](double time) {
      const ros::Time stamp = PairPublisher::stampOf(20 + time);
      cameras_->publishLeft(stamp, scene_.image(time, false), scene_.info(false));
      cameras_->publishRight(stamp, scene_.image(time, true), scene_.info(true));
      return stamp;
    };
    const ros::Time stamp = publish(t);
    const auto of_pair = [&](const LandingEstimate& e) { return e.header.stamp == stamp; };
    ASSERT_TRUE(eventually([&] { return has(of_pair); })) << i;
    if (i < 20) continue;
    EXPECT_TRUE(has([&](const LandingEstimate& e) { return of_pair(e) && e.valid; })) << i;
    if (i % 4 == 0) publish(t - 0.5 * kStep);
  }
  EXPECT_TRUE(diagnosticsSay([](const diagnostic_msgs::KeyValue& value) {
    return value.key == "/stereo/left/image_raw" && value.value.find(" 6 of them late") != std::string::npos;
  }));
}

TEST_F(AbuseTest, AFloodOf200Hz) {
  const auto left = scene_.image(0, false), right = scene_.image(0, true);
  for (int i = 0; i < 400; ++i) {
    const ros::Time stamp = PairPublisher::stampOf(10 + 0.005 * i);
    cameras_->publishLeft(stamp, boost::make_shared<sensor_msgs::Image>(*left), scene_.info(false));
    cameras_->publishRight(stamp, boost::make_shared<sensor_msgs::Image>(*right), scene_.info(true));
  }
  expectRecovery(20);
  EXPECT_TRUE(diagnosticsSay([](const diagnostic_msgs::KeyValue& value) {
    return leftDropped(value) > 0 || (value.key == "pairs dropped" && value.value != "0");
  }));
}

TEST_F(AbuseTest, OneCameraThatGoesOnAlone) {
  for (int i = 0; i < 200; ++i)
    cameras_->publishLeft(PairPublisher::stampOf(10 + 0.05 * i), scene_.blank(100), scene_.info(false));
  expectRecovery(30);
  EXPECT_TRUE(diagnosticsSay([](const diagnostic_msgs::KeyValue& value) { return leftDropped(value) > 0; }));
}

TEST_F(AbuseTest, SubscribersThatNeverRead) {
  ros::CallbackQueue never_read;
  ros::NodeHandle handle;
  handle.setCallbackQueue(&never_read);
  const std::vector<ros::Subscriber> slow = {
      handle.subscribe<sensor_msgs::Image>("/uav_landing/left/image_rect", 1, &ignore<sensor_msgs::Image>),
      handle.subscribe<StereoDepth>("/uav_landing/stereo_depth", 1, &ignore<StereoDepth>),
      handle.subscribe<LandingEstimate>("/uav_landing/landing_estimate", 1, &ignore<LandingEstimate>)};
  ASSERT_TRUE(eventually([&] { return slow[0].getNumPublishers() > 0 && slow[2].getNumPublishers() > 0; }));
  for (int i = 0; i < 200; ++i) cameras_->publishUniform(scene_, 10 + 0.05 * i, 100);
  expectRecovery(30);
}

TEST_F(AbuseTest, NodeletsThatAreUnloadedAndLoadedAgain) {
  double t = 10;
  for (const char* nodelet : kNodelets) {
    SCOPED_TRACE(nodelet);
    unload(nodelet);
    cameras_->publish(scene_, t);
    load(nodelet);
    expectRecovery(t + 5);
    t += 10;
  }
}

TEST_F(AbuseTest, AnInertialSensorOutOfItsMind) {
  const ros::Publisher imu = handle_.advertise<sensor_msgs::Imu>("/imu/data", 5000);
  const ros::Publisher tf = handle_.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  ASSERT_TRUE(eventually([&] { return imu.getNumSubscribers() > 0 && tf.getNumSubscribers() > 0; }));
  for (const auto& [parent, child] : {std::pair("imu_link", "left_optical"), {"left_optical", "imu_link"}}) {
    tf2_msgs::TFMessage mounting;
    mounting.transforms.resize(1);
    mounting.transforms[0].header.frame_id = parent;
    mounting.transforms[0].child_frame_id = child;
    mounting.transforms[0].transform.rotation.w = 1;
    tf.publish(mounting);
  }
  const ros::Time stamps[] = {{}, ros::TIME_MAX, PairPublisher::stampOf(50), PairPublisher::stampOf(-50)};
  for (int i = 0; i < 4000; ++i) {
    sensor_msgs::Imu message;
    message.header.stamp = stamps[i % 4];
    message.header.frame_id = i % 3 == 0 ? "head" : "imu_link";
    message.orientation.w = i % 5 == 0 ? std::nan("") : 1;
    message.angular_velocity.x = i % 7 == 0 ? 1e300 : 3;
    message.orientation_covariance.fill(i % 11 == 0 ? 1e308 : 0);
    imu.publish(message);
  }
  expectRecovery(30);
  EXPECT_TRUE(diagnosticsSay([](const diagnostic_msgs::KeyValue& value) {
    return value.key == "inputs refused" && value.value != "0";
  }));
}

TEST_F(AbuseTest, SomebodyElseWhoPublishesNonsense) {
  const ros::Publisher depths = handle_.advertise<StereoDepth>("/uav_landing/stereo_depth", 10);
  const ros::Publisher angles = handle_.advertise<ApproachAngle>("/uav_landing/approach_angle", 10);
  const ros::Publisher infos =
      handle_.advertise<sensor_msgs::CameraInfo>("/uav_landing/left/camera_info", 10);
  const ros::Publisher raw_infos = handle_.advertise<sensor_msgs::CameraInfo>("/stereo/left/camera_info", 10);
  ASSERT_TRUE(eventually([&] { return depths.getNumSubscribers() > 0 && angles.getNumSubscribers() > 0; }));
  for (const double t : {2.0, -7.0, 1000.0}) {
    auto depth = boost::make_shared<StereoDepth>();
    depth->header.stamp = PairPublisher::stampOf(t);
    depth->u.resize(7);
    auto angle = boost::make_shared<ApproachAngle>();
    auto info = boost::make_shared<sensor_msgs::CameraInfo>();
    angle->header = info->header = depth->header;
    depths.publish(depth);
    angles.publish(angle);
    infos.publish(info);
    raw_infos.publish(info);
    expectRecovery(t + 3);
  }
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("abuse_nodelet_test")
