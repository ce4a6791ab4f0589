#include <uav_landing/StereoDepth.h>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using uav_landing::StereoDepth;

namespace {

class StereoDepthNodeletTest : public NodeletTest {
 protected:
  void start() {
    setParameter("stereo_depth", "complaint_period", 0.2);
    setParameter("stereo_depth", "search_at_once", true);
    load("stereo_depth");
    output_ = std::make_unique<Listener<StereoDepth>>("/uav_landing/stereo_depth");
    ASSERT_TRUE(
        eventually([&] { return images_.connected() && images_.timeIsConnected() && output_->connected(); }));
  }

  StereoScene scene_;
  PairPublisher images_{PairPublisher::kRectified};
  std::unique_ptr<Listener<StereoDepth>> output_;
};

TEST_F(StereoDepthNodeletTest, SubscribesOnlyWhileSomebodyListens) {
  load("stereo_depth");
  EXPECT_TRUE(images_.unconnected());
  {
    Listener<StereoDepth> listener("/uav_landing/stereo_depth");
    EXPECT_TRUE(eventually([&] { return images_.connected(); }));
  }
  EXPECT_TRUE(eventually([&] { return images_.unconnected(); }));
}

TEST_F(StereoDepthNodeletTest, FindsThePlaneBelow) {
  start();
  images_.publish(scene_, 0);
  ASSERT_TRUE(output_->waitFor(1));
  const StereoDepth depth = *output_->messages()[0];
  EXPECT_EQ(depth.reason, "");
  EXPECT_EQ(depth.header.stamp, PairPublisher::stampOf(0));
  EXPECT_EQ(depth.header.frame_id, "left_optical");
  EXPECT_GT(depth.u.size(), 50u);
  // g = n / h with n = (0, cos pitch, -sin pitch).
  EXPECT_NEAR(depth.plane[0], 0, 0.01);
  EXPECT_NEAR(depth.plane[1], std::cos(scene_.pitch) / 2.0, 0.01);
  EXPECT_NEAR(depth.plane[2], -std::sin(scene_.pitch) / 2.0, 0.01);
  EXPECT_GT(depth.compute_ms, 0);
}

TEST_F(StereoDepthNodeletTest, BlackAndSaturatedImagesHaveTheirMessageToo) {
  start();
  images_.publishUniform(scene_, 0, 0);
  images_.publishUniform(scene_, 0.1, 255);
  images_.publish(scene_, 0.2);
  ASSERT_TRUE(output_->waitFor(3));
  const auto depths = output_->messages();
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(depths[i]->reason.rfind("uniform_image", 0), 0u) << depths[i]->reason;
    EXPECT_TRUE(std::isnan(depths[i]->plane[1]));
  }
  EXPECT_EQ(depths[2]->reason, "");
}

TEST_F(StereoDepthNodeletTest, SwappedCamerasAreSaidToBeSwapped) {
  start();
  images_.publishLeft(ros::Time(1000), scene_.image(0, true), scene_.info(false));
  images_.publishRight(ros::Time(1000), scene_.image(0, false), scene_.info(true));
  ASSERT_TRUE(output_->waitFor(1));
  EXPECT_EQ(output_->messages()[0]->reason.rfind("negative_disparity", 0), 0u)
      << output_->messages()[0]->reason;
  EXPECT_TRUE(logged("left and right images are swapped"));
}

TEST_F(StereoDepthNodeletTest, TheSkewIsReported) {
  start();
  const ros::Publisher times =
      handle_.advertise<sensor_msgs::TimeReference>("/uav_landing/right/time_reference", 1);
  ASSERT_TRUE(eventually([&] { return times.getNumSubscribers() > 0; }));
  // The helper sends the time of the pair itself; this one comes first and counts.
  auto time = boost::make_shared<sensor_msgs::TimeReference>();
  time->header.stamp = PairPublisher::stampOf(0);
  time->time_ref = PairPublisher::stampOf(0.004);
  times.publish(time);
  images_.publish(scene_, 0);
  ASSERT_TRUE(output_->waitFor(1));
  EXPECT_NEAR(output_->messages()[0]->skew, 0.004, 1e-9);
}

TEST_F(StereoDepthNodeletTest, ABaselineOfZeroIsTheReasonOfEveryMessage) {
  start();
  StereoScene mono = scene_;
  mono.baseline = 0;
  images_.publish(mono, 0);
  images_.publish(mono, 0.1);
  ASSERT_TRUE(output_->waitFor(2));
  for (const auto& depth : output_->messages()) {
    EXPECT_EQ(depth->reason.rfind("input_invalid: camera_info: right P[3]", 0), 0u) << depth->reason;
  }
}

TEST_F(StereoDepthNodeletTest, GoesOnAfterAJumpBackInTime) {
  start();
  images_.publish(scene_, 10);
  ASSERT_TRUE(output_->waitFor(1));
  images_.publish(scene_, 0);
  images_.publish(scene_, 0.1);
  ASSERT_TRUE(output_->waitFor([](const auto& depth) {
    return depth.header.stamp == PairPublisher::stampOf(0.1) && depth.reason.empty();
  }));
}

TEST_F(StereoDepthNodeletTest, GoesOnWithCamerasOfAnotherSize) {
  start();
  images_.publish(scene_, 0);
  StereoScene smaller = scene_;
  smaller.width = 280;
  smaller.height = 220;
  images_.publish(smaller, 0.1);
  ASSERT_TRUE(output_->waitFor(2));
  EXPECT_EQ(output_->messages()[1]->reason, "");
  EXPECT_NEAR(output_->messages()[1]->plane[1], std::cos(scene_.pitch) / scene_.heightAt(0.1), 0.01);
}

TEST_F(StereoDepthNodeletTest, TheMissingRightImageIsNamed) {
  start();
  double t = 0;
  EXPECT_TRUE(eventually([&] {
    images_.publishLeft(PairPublisher::stampOf(t += 0.1), scene_.blank(0), scene_.info(false));
    return wholeLog().find("no message on /uav_landing/right/image_rect") != std::string::npos;
  })) << wholeLog();
}

TEST_F(StereoDepthNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("stereo_depth", "matching_cost", std::string("sad"));
  expectRefusal("stereo_depth", "stereo_depth/matching_cost: 'sad' is not a choice, expected zncc or ssd");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("stereo_depth_nodelet_test")
