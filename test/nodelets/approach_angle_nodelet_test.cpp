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
  void start() {
    setParameter("approach_angle", "complaint_period", 0.2);
    load("approach_angle");
    output_ = std::make_unique<Listener<ApproachAngle>>("/uav_landing/approach_angle");
    ASSERT_TRUE(eventually([&] { return images_.connected() && output_->connected(); }));
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

TEST_F(ApproachAngleNodeletTest, RunsWithoutStereoWhenToldTo) {
  setParameter("approach_angle", "use_stereo", false);
  start();
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

TEST_F(ApproachAngleNodeletTest, BadParametersRefuseToLoadByName) {
  setParameter("approach_angle", "angle_window", -1);
  expectRefusal("approach_angle", "approach_angle/angle_window: -1 is out of range");
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("approach_angle_nodelet_test")
