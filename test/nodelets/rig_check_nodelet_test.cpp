// Calibrations that make heights look right and be wrong: each nodelet refuses them, or warns.
#include <uav_landing/ApproachAngle.h>
#include <uav_landing/LandingEstimate.h>
#include <uav_landing/StereoDepth.h>
#include <unistd.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "nodelets/nodelet_fixture.h"
#include "nodelets/nodelet_test_main.h"
#include "nodelets/stereo_scene.h"

using namespace uav_landing::test;
using diagnostic_msgs::DiagnosticStatus;

namespace {

constexpr const char* kBehindRectify[] = {"stereo_depth", "approach_angle", "kalman_height", "overlay"};

class RigCheckNodeletTest : public NodeletTest {
 protected:
  template <class Names>
  void start(const Names& nodelets) {
    for (const char* nodelet : nodelets) {
      // All pairs count, however long a test is stopped.
      setParameter(nodelet, "drop_frames", false);
      setParameter(nodelet, "diagnostic_period", 0.2);
      load(nodelet);
    }
    ASSERT_TRUE(eventually([&] {
      return depths_.connected() && angles_.connected() && estimates_.connected() && pictures_.connected();
    }));
  }
  void startWholeChain() {
    cameras_ = std::make_unique<PairPublisher>(PairPublisher::kRaw);
    start(std::initializer_list<const char*>{"rectify", "stereo_depth", "approach_angle", "kalman_height",
                                             "overlay"});
    ASSERT_TRUE(eventually([&] { return cameras_->connected(); }));
  }
  void startBehindRectify() {
    cameras_ = std::make_unique<PairPublisher>(PairPublisher::kRectified);
    start(kBehindRectify);
    ASSERT_TRUE(eventually([&] { return cameras_->connected() && cameras_->timeIsConnected(); }));
  }

  /// Publishes pairs until this holds, as fast as their estimates come.
  bool feedUntil(const std::function<bool()>& condition) {
    return eventually([&] {
      constexpr size_t kOnTheirWay = 3;
      if (published_ < estimates_.messages().size() + kOnTheirWay) {
        cameras_->publish(scene_, 0.05 * static_cast<double>(published_));
        ++published_;
      }
      return condition();
    });
  }

  template <class Message>
  static bool hasReason(const Listener<Message>& listener, const std::string& reason) {
    for (const auto& message : listener.messages())
      if (message->reason == reason) return true;
    return false;
  }

  /// Every nodelet behind rectify says so, and no height is valid.
  void expectRefused(const std::string& message) {
    const std::string reason = "input_invalid: " + message;
    ASSERT_TRUE(feedUntil([&] {
      return hasReason(depths_, reason) && hasReason(angles_, reason) && hasReason(estimates_, reason) &&
             diagnostics_.said("stereo_depth", DiagnosticStatus::ERROR, reason) &&
             diagnostics_.said("approach_angle", DiagnosticStatus::ERROR, reason) &&
             diagnostics_.said("kalman_height", DiagnosticStatus::WARN, reason) &&
             diagnostics_.said("overlay", DiagnosticStatus::ERROR, message);
    })) << wholeLog();
    for (const char* nodelet : {"stereo_depth", "approach_angle"})
      EXPECT_TRUE(logged(std::string("/uav_landing/") + nodelet + ": " + reason)) << wholeLog();
    EXPECT_TRUE(logged("/uav_landing/overlay: " + message)) << wholeLog();
    for (const auto& estimate : estimates_.messages()) EXPECT_FALSE(estimate->height_valid);
    EXPECT_TRUE(pictures_.messages().empty());
  }

  StereoScene scene_;
  size_t published_ = 0;
  Diagnostics diagnostics_;
  std::unique_ptr<PairPublisher> cameras_;
  Listener<uav_landing::StereoDepth> depths_{"/uav_landing/stereo_depth"};
  Listener<uav_landing::ApproachAngle> angles_{"/uav_landing/approach_angle"};
  Listener<uav_landing::LandingEstimate> estimates_{"/uav_landing/landing_estimate"};
  Listener<sensor_msgs::Image> pictures_{"/uav_landing/overlay/image"};
};

TEST_F(RigCheckNodeletTest, ABaselineInMillimetresIsTheReasonOfEveryStage) {
  startWholeChain();
  scene_.baseline = 300;
  expectRefused(
      "camera_info: baseline 300 m, expected at most 50 m: is right P[3] in metres (-fx times the baseline)? "
      "If it is, raise rig/max_baseline");
}

TEST_F(RigCheckNodeletTest, APrincipalPointOfAnotherPictureSizeIsRefusedAlsoWhereSomebodyElseRectifies) {
  startBehindRectify();
  scene_.calibrated_scale = 2;
  expectRefused(
      "camera_info: left K[2]: 320, expected 96 to 224 in an image 320 px wide: is this the calibration of "
      "another image size? If the image is cropped off the middle, raise "
      "rig/max_principal_point_offset");
}

TEST_F(RigCheckNodeletTest, AMaskOfAnotherSizeIsTheReasonOfEveryStage) {
  const std::string file = testing::TempDir() + "rig_check_mask_" + std::to_string(getpid()) + ".png";
  ASSERT_TRUE(cv::imwrite(file, cv::Mat(100, 200, CV_8UC1, cv::Scalar(255))));
  setParameter("rig", "right_mask", file);
  startWholeChain();
  const std::string reason =
      "input_invalid: rig/right_mask: " + file +
      ": is 200x100, expected 320x240, the size of the raw images by camera_info; draw it "
      "on a raw image of this camera";
  ASSERT_TRUE(feedUntil([&] {
    return hasReason(depths_, reason) && hasReason(angles_, reason) && hasReason(estimates_, reason) &&
           diagnostics_.said("stereo_depth", DiagnosticStatus::ERROR, reason) &&
           diagnostics_.said("approach_angle", DiagnosticStatus::ERROR, reason);
  })) << wholeLog();
  EXPECT_TRUE(logged("/uav_landing/stereo_depth: " + reason)) << wholeLog();
  for (const auto& estimate : estimates_.messages()) EXPECT_FALSE(estimate->height_valid);
  std::remove(file.c_str());
}

TEST_F(RigCheckNodeletTest, NoPointIsWhereAMaskIs) {
  const std::string file = testing::TempDir() + "rig_check_mask_" + std::to_string(getpid()) + ".png";
  cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(255));
  mask.colRange(0, 160) = 0;
  ASSERT_TRUE(cv::imwrite(file, mask));
  setParameter("rig", "left_mask", file);
  startWholeChain();
  ASSERT_TRUE(feedUntil([&] {
    return estimates_.waitFor([](const auto& estimate) { return estimate.height_valid; },
                              std::chrono::milliseconds(1));
  })) << wholeLog();
  for (const auto& depth : depths_.messages())
    for (const double u : depth->u) EXPECT_GT(u, 160);
  std::remove(file.c_str());
}

TEST_F(RigCheckNodeletTest, APictureCroppedOffTheMiddleIsLetThroughByTheSharedParameter) {
  setParameter("rig", "max_principal_point_offset", 1.1);
  startBehindRectify();
  scene_.calibrated_scale = 2;
  ASSERT_TRUE(feedUntil([&] {
    return hasReason(depths_, "") && hasReason(angles_, "") && !pictures_.messages().empty() &&
           estimates_.waitFor([](const auto& estimate) { return estimate.height_valid; },
                              std::chrono::milliseconds(1));
  })) << wholeLog();
  EXPECT_EQ(wholeLog().find("another image size"), std::string::npos) << wholeLog();
}

TEST_F(RigCheckNodeletTest, AnUnlikelyCalibrationIsWarnedAboutOnceAndInDiagnosticsAsLongAsItHolds) {
  startWholeChain();
  const char* const nodelets[] = {"rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay"};
  scene_.calibrated_scale = 1.25;
  const std::string
      left =
          "camera_info: left K[2]: 200, 12.5 % of the image's width off its middle: is this the "
          "calibration of another image size?",
      right =
          "camera_info: right K[2]: 200, 12.5 % of the image's width off its middle: is "
          "this the calibration of another image size?";
  ASSERT_TRUE(feedUntil([&] {
    for (const char* nodelet : nodelets)
      if (!diagnostics_.said(nodelet, DiagnosticStatus::WARN, left + "; " + right)) return false;
    return true;
  })) << wholeLog();
  for (const std::string nodelet : nodelets) {
    EXPECT_TRUE(logged("/uav_landing/" + nodelet + ": " + right));
    EXPECT_EQ(timesLogged("/uav_landing/" + nodelet + ": " + left), 1u) << wholeLog();
    EXPECT_EQ(timesLogged("/uav_landing/" + nodelet + ": " + right), 1u) << wholeLog();
  }
  bool valid = false;
  for (const auto& estimate : estimates_.messages()) valid = valid || estimate->height_valid;
  EXPECT_TRUE(valid) << "a warning only";

  scene_.calibrated_scale = 1;
  diagnostics_.clear();
  ASSERT_TRUE(feedUntil([&] {
    for (const char* nodelet : nodelets)
      if (!diagnostics_.said(nodelet, DiagnosticStatus::OK, "running")) return false;
    return true;
  })) << "the warning ends with its calibration";
}

TEST_F(RigCheckNodeletTest, AnUnlikelyBaselineIsWarnedAboutByEveryNodelet) {
  startWholeChain();
  scene_.baseline = 15;
  const std::string warning = "camera_info: baseline 15 m: is right P[3] in metres (-fx times the baseline)?";
  ASSERT_TRUE(feedUntil([&] {
    for (const std::string nodelet :
         {"rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay"})
      if (timesLogged("/uav_landing/" + nodelet + ": " + warning) != 1) return false;
    return true;
  })) << wholeLog();
}

}  // namespace

UAV_LANDING_NODELET_TEST_MAIN("rig_check_nodelet_test")
