#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;

namespace {

class OverlayNodeletTest : public NodeletTest {
 protected:
  bool resultsConnected() const {
    return stereo_.getNumSubscribers() > 0 && approach_.getNumSubscribers() > 0 &&
           estimate_.getNumSubscribers() > 0;
  }
  /// Results with nothing in them, as of a pair where nothing was found.
  void publish(double t) {
    images_.publishUniform(scene_, t, 100);
    const auto stamp = PairPublisher::stampOf(t);
    auto stereo = boost::make_shared<uav_landing::StereoDepth>();
    auto approach = boost::make_shared<uav_landing::ApproachAngle>();
    auto estimate = boost::make_shared<uav_landing::LandingEstimate>();
    stereo->header.stamp = approach->header.stamp = estimate->header.stamp = stamp;
    stereo->reason = approach->reason = estimate->reason = "uniform_image";
    stereo->plane.assign(std::nan(""));
    approach->n.assign(std::nan(""));
    approach->foe.assign(std::nan(""));
    approach->vanishing_direction.assign(std::nan(""));
    estimate->height = estimate->approach_angle = std::nan("");
    stereo_.publish(stereo);
    approach_.publish(approach);
    estimate_.publish(estimate);
  }

  StereoScene scene_;
  PairPublisher images_{PairPublisher::kRectified};
  ros::Publisher stereo_ = handle_.advertise<uav_landing::StereoDepth>("/uav_landing/stereo_depth", 10);
  ros::Publisher approach_ = handle_.advertise<uav_landing::ApproachAngle>("/uav_landing/approach_angle", 10);
  ros::Publisher estimate_ =
      handle_.advertise<uav_landing::LandingEstimate>("/uav_landing/landing_estimate", 10);
};

TEST_F(OverlayNodeletTest, SubscribesOnlyWhileSomebodyLooks) {
  load("overlay");
  EXPECT_FALSE(resultsConnected());
  {
    Listener<sensor_msgs::Image> listener("/uav_landing/overlay/image");
    EXPECT_TRUE(eventually([&] { return resultsConnected(); }));
  }
  EXPECT_TRUE(eventually([&] { return stereo_.getNumSubscribers() == 0; }));
}

TEST_F(OverlayNodeletTest, DrawsAPictureOfTheImagesStampAlsoWhenNothingWasFound) {
  load("overlay");
  Listener<sensor_msgs::Image> picture("/uav_landing/overlay/image");
  ASSERT_TRUE(eventually([&] { return resultsConnected() && picture.connected(); }));
  publish(0);
  publish(0.1);
  ASSERT_TRUE(picture.waitFor(2));
  EXPECT_EQ(picture.messages()[1]->header.stamp, PairPublisher::stampOf(0.1));
  EXPECT_EQ(picture.messages()[1]->encoding, "bgr8");
  EXPECT_EQ(picture.messages()[1]->width, 640u) << "enlarged";
}

TEST_F(OverlayNodeletTest, WhatImageTransportKeepsBelowItsNameIsNoParameter) {
  // As its plugins leave it behind for the next nodelet of this name.
  ros::param::set("/uav_landing/overlay/image/compressed/format", "jpeg");
  ros::param::set("/uav_landing/overlay/image/disable_pub_plugins",
                  std::vector<std::string>{"image_transport/compressed"});
  load("overlay");
}

TEST_F(OverlayNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("overlay", "scale", 9);
  expectRefusal("overlay", "overlay/scale: 9 is out of range");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("overlay_nodelet_test")
