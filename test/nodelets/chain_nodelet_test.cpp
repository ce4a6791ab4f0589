#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/Range.h>
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>

#include <algorithm>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using uav_landing::ApproachAngle;
using uav_landing::LandingEstimate;
using uav_landing::StereoDepth;

namespace {

/// All nodelets together, fed with a rendered descent.
class ChainTest : public NodeletTest {
 protected:
  void start(bool drop_frames) {
    for (const char* nodelet : {"rectify", "kalman_height"})
      setParameter(nodelet, "drop_frames", drop_frames);
    for (const char* nodelet : {"rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay"}) {
      setParameter(nodelet, "diagnostic_period", 0.2);
      load(nodelet);
    }
    ASSERT_TRUE(eventually([&] { return cameras_.connected() && estimates_.connected(); }));
    // The first pairs may be lost while the stages connect to each other.
    ASSERT_TRUE(eventually([&] {
      cameras_.publishUniform(scene_, warm_up_ += 0.01, 0);
      return estimates_.waitFor([](const auto& e) { return e.reason.rfind("uniform_image", 0) == 0; },
                                std::chrono::milliseconds(200));
    }));
  }

  StereoScene scene_;
  double warm_up_ = -100;
  PairPublisher cameras_{PairPublisher::kRaw};
  Listener<LandingEstimate> estimates_{"/uav_landing/landing_estimate"};
};

TEST_F(ChainTest, EveryPairOfADescentHasItsEstimate) {
  start(false);
  estimates_.clear();
  Listener<sensor_msgs::Image> overlay("/uav_landing/overlay/image");
  ASSERT_TRUE(eventually([&] { return overlay.connected(); }));
  for (int i = 0; i < 12; ++i) {
    if (i == 6)
      cameras_.publishUniform(scene_, 0.1 * i, 0);
    else
      cameras_.publish(scene_, 0.1 * i);
  }
  // Estimates of pairs from before may still come.
  const auto ofTheDescent = [&] {
    auto estimates = estimates_.messages();
    estimates.erase(std::remove_if(estimates.begin(), estimates.end(),
                                   [](const auto& estimate) {
                                     return estimate->header.stamp < PairPublisher::stampOf(0);
                                   }),
                    estimates.end());
    return estimates;
  };
  ASSERT_TRUE(eventually([&] { return ofTheDescent().size() >= 12; }));
  const auto estimates = ofTheDescent();
  for (size_t i = 0; i < 12; ++i)
    EXPECT_EQ(estimates[i]->header.stamp, PairPublisher::stampOf(0.1 * static_cast<double>(i)));
  EXPECT_FALSE(estimates[0]->valid);
  EXPECT_EQ(estimates[6]->status, LandingEstimate::COASTING) << "a black pair";
  const LandingEstimate last = *estimates[11];
  EXPECT_TRUE(last.valid) << last.reason;
  EXPECT_NEAR(last.height, scene_.heightAt(1.1), 0.02);
  EXPECT_NEAR(last.approach_angle, scene_.approach_angle, 0.5 * M_PI / 180);
  EXPECT_NEAR(last.pitch, scene_.pitch, 0.2 * M_PI / 180);
  // The overlay may have begun to listen after these pairs.
  double t = 1.1;
  ASSERT_TRUE(eventually([&] {
    cameras_.publish(scene_, t += 0.1);
    return overlay.waitFor([](const auto&) { return true; }, std::chrono::milliseconds(500));
  }));
  EXPECT_EQ(overlay.messages()[0]->encoding, "bgr8");
  EXPECT_GE(overlay.messages()[0]->width, 640u);
}

TEST_F(ChainTest, WithoutTheTransformItRestsWhileNobodyWantsItsOutput) {
  setParameter("kalman_height", "publish_tf", false);
  for (const char* nodelet : {"rectify", "stereo_depth", "approach_angle", "kalman_height"}) load(nodelet);
  ASSERT_TRUE(eventually([&] { return cameras_.connected(); }));
  estimates_.leave();
  EXPECT_TRUE(eventually([&] { return cameras_.unconnected(); })) << "the only subscriber left";
  {
    const Listener<sensor_msgs::Range> height("/uav_landing/height");
    EXPECT_TRUE(eventually([&] { return cameras_.connected(); })) << "another output";
  }
  EXPECT_TRUE(eventually([&] { return cameras_.unconnected(); }));
}

TEST_F(ChainTest, WhenBehindTheNewestPairIsServedAndTheRestCounted) {
  start(true);
  estimates_.clear();
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics("/diagnostics");
  // Far faster than the chain can go.
  for (int i = 0; i < 300; ++i) cameras_.publishUniform(scene_, 0.01 * i, i % 2 == 0 ? 100 : 101);
  const auto picture = scene_.image(4, false), right_picture = scene_.image(4, true);
  for (int i = 0; i < 200; ++i) {
    cameras_.publishLeft(PairPublisher::stampOf(4 + 0.001 * i),
                         boost::make_shared<sensor_msgs::Image>(*picture), scene_.info(false));
    cameras_.publishRight(PairPublisher::stampOf(4 + 0.001 * i),
                          boost::make_shared<sensor_msgs::Image>(*right_picture), scene_.info(true));
  }
  const ros::Time last = PairPublisher::stampOf(4 + 0.001 * 199);
  ASSERT_TRUE(estimates_.waitFor([&](const auto& e) { return e.header.stamp == last; }))
      << "the newest is served";
  EXPECT_LT(estimates_.messages().size(), 450u);
  EXPECT_TRUE(diagnostics.waitFor([](const auto& array) {
    for (const auto& status : array.status)
      for (const auto& value : status.values)
        if (status.name == "uav_landing/rectify: rectify" && value.key == "pairs dropped" &&
            value.value != "0")
          return true;
    return false;
  }));
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("chain_nodelet_test")
