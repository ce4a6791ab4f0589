#include "uav_landing/simulator/approach_simulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/approach/sensor.h"

namespace uav_landing {
namespace {

/// Two seconds with small pictures.
SimulatorParameters smallApproach() {
  SimulatorParameters p;
  p.setPictures(160, 120, 138);
  p.path.duration = 2;
  p.path.rate = 10;
  return p;
}

bool same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(ApproachSimulator, HasAFrameAtBothEndsOfTheDuration) {
  const ApproachSimulator simulator = ApproachSimulator::create(smallApproach()).value();
  EXPECT_EQ(simulator.frames(), 21);
  EXPECT_EQ(simulator.timeOf(20), 2.0);
}

TEST(ApproachSimulator, SameSeedGivesTheSameFramesInAnyOrder) {
  const ApproachSimulator one = ApproachSimulator::create(smallApproach()).value();
  const ApproachSimulator other = ApproachSimulator::create(smallApproach()).value();
  const cv::Mat later = one.frame(3).right, earlier = one.frame(1).right;
  EXPECT_TRUE(same(other.frame(1).right, earlier));
  EXPECT_TRUE(same(other.frame(3).right, later));
}

TEST(ApproachSimulator, AnotherSeedGivesOtherPictures) {
  SimulatorParameters p = smallApproach();
  const cv::Mat first = ApproachSimulator::create(p)->frame(0).left;
  p.random.seed = 2;
  EXPECT_FALSE(same(first, ApproachSimulator::create(p)->frame(0).left));
}

TEST(ApproachSimulator, NoiseDiffersFromFrameToFrameAndBetweenTheCameras) {
  SimulatorParameters p = smallApproach();
  p.path.speed = 0;
  p.wobble.roll_deg = p.wobble.pitch_deg = p.wobble.yaw_deg = p.wobble.sway = p.wobble.heave = 0;
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  const cv::Mat first = simulator.frame(1).left, second = simulator.frame(2).left;
  // The scene stands still: the difference is noise of both, rounded to whole grey levels (variance 1/12
  // each).
  cv::Mat difference;
  cv::subtract(first, second, difference, cv::noArray(), CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(difference, mean, deviation);
  EXPECT_NEAR(deviation[0], std::sqrt(2 * (2.0 * 2.0 + 1.0 / 12)), 0.06);
  cv::subtract(simulator.frame(1).right, first, difference, cv::noArray(), CV_32F);
  cv::meanStdDev(difference(cv::Rect(0, 0, 160, 30)), mean,
                 deviation);  // sky: the same in both but for the noise
  EXPECT_NEAR(deviation[0], std::sqrt(2 * (2.0 * 2.0 + 1.0 / 12)), 0.15);
}

TEST(ApproachSimulator, OneRenderingServesSeveralNoiseLevels) {
  SimulatorParameters p = smallApproach();
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  const ApproachSimulator::Light light = simulator.light(2);
  for (const double noise : {5.0, 2.0}) {
    p.image.noise = noise;
    const ApproachSimulator::Frame frame = simulator.expose(light, noise);
    const ApproachSimulator::Frame expected = ApproachSimulator::create(p)->frame(2);
    EXPECT_TRUE(same(frame.left, expected.left)) << noise;
    EXPECT_TRUE(same(frame.right, expected.right)) << noise;
    EXPECT_EQ(frame.truth.approach_angle, expected.truth.approach_angle);
  }
}

TEST(ApproachSimulator, TruthOfTheStepIsThatFromThePreviousFrame) {
  const ApproachSimulator simulator = ApproachSimulator::create(smallApproach()).value();
  EXPECT_TRUE(std::isnan(simulator.frame(0).truth.approach_angle));
  const Eigen::Vector3d step = simulator.pose(0.5).position - simulator.pose(0.4).position;
  const Truth truth = simulator.frame(5).truth;
  EXPECT_NEAR(truth.approach_angle, std::atan2(-step.z(), std::hypot(step.x(), step.y())), 1e-12);
  EXPECT_NEAR(truth.speed, step.norm() / 0.1, 1e-9);
  EXPECT_EQ(truth.height, simulator.pose(0.5).position.z());
}

TEST(ApproachSimulator, TrueHeightIsThatAboveTheGroundBelowTheCamera) {
  SimulatorParameters p = smallApproach();
  const double flat = ApproachSimulator::create(p)->frame(5).truth.height;
  p.profile.slope_before_deg = 1;
  // The slope ends 50 m before the threshold; the camera is farther out: path.start_x is -330.
  p.profile.change_start = -150;
  p.profile.change_length = 100;
  const ApproachSimulator simulator = ApproachSimulator::create(p).value();
  const double x = simulator.pose(0.5).position.x();
  // The ground rises by half the slope over the change of slope, and by all of it before.
  const double below = std::tan(M_PI / 180) * (0.5 * 100 + (-150 - x));
  EXPECT_NEAR(simulator.frame(5).truth.height, flat + below, 1e-9);
}

TEST(ApproachSimulator, MotionBlurIsTheAverageOverTheExposureAroundTheStamp) {
  SimulatorParameters p = smallApproach();
  p.image.noise = 0;
  p.wobble.roll_deg = 20;
  p.path.rate = 160;
  const ApproachSimulator sharp = ApproachSimulator::create(p).value();
  // Four samples over 8 frame intervals: in the middle of each quarter, 1 and 3 intervals before and after.
  p.image.exposure_time = 8 / 160.0;
  p.image.exposure_samples = 4;
  const cv::Mat smeared = ApproachSimulator::create(p)->frame(60).left;
  cv::Mat sum = cv::Mat::zeros(smeared.size(), CV_32F);
  for (const int index : {57, 59, 61, 63}) cv::add(sum, sharp.frame(index).left, sum, cv::noArray(), CV_32F);
  cv::Mat difference;
  cv::subtract(0.25 * sum, smeared, difference, cv::noArray(), CV_32F);
  EXPECT_LE(cv::norm(difference, cv::NORM_INF), 1.0) << "but for rounding";
  EXPECT_GT(cv::norm(smeared, sharp.frame(60).left, cv::NORM_INF), 5);
}

TEST(ApproachSimulator, ADriftingClockExposesItsCameraLaterThanTheStamp) {
  SimulatorParameters p = smallApproach();
  p.path.rate = 20;
  const ApproachSimulator alike = ApproachSimulator::create(p).value();
  p.right_camera.clock_drift = 0.1;
  p.right_camera.clock_drift_start = 0.5;
  const ApproachSimulator drifting = ApproachSimulator::create(p).value();
  // A second after the start it has drifted for half of that time: one frame.
  EXPECT_TRUE(same(drifting.light(20).left, alike.light(20).left));
  EXPECT_TRUE(same(drifting.light(20).right, alike.light(21).right));
  EXPECT_TRUE(same(drifting.light(10).right, alike.light(10).right));
  EXPECT_EQ(drifting.frame(20).truth.height, alike.frame(20).truth.height) << "of the stamp";
}

TEST(ApproachSimulator, PathIntoTheGroundIsRefusedWithTheTimeOfTheTouch) {
  SimulatorParameters p = smallApproach();
  p.path.start_height = 1;
  p.path.glide_angle_deg = 10;
  p.path.flare_height = 0;
  p.wobble.roll_deg = p.wobble.heave = 0;
  // 1 m at 20 m/s and 10 degrees takes 0.288 s.
  const Expected<ApproachSimulator> simulator = ApproachSimulator::create(p);
  ASSERT_FALSE(simulator);
  EXPECT_EQ(simulator.error().detail, "path/duration: a camera touches the ground after 0.3 s");
}

TEST(Sensor, GainComesBeforeOffset) {
  SimulatedImageParameters image;
  image.noise = 0;
  SimulatedCameraParameters camera;
  camera.gain = 1.05;
  camera.offset = 3;
  cv::Mat grey(20, 20, CV_32F, cv::Scalar(100)), mono8;
  expose(image, camera, 1, grey, mono8);
  EXPECT_TRUE(same(mono8, cv::Mat(20, 20, CV_8U, cv::Scalar(108))));
}

TEST(Sensor, NoiseHasTheDeviationAskedForAndNoMean) {
  SimulatedImageParameters image;
  image.noise = 3;
  cv::Mat grey(300, 300, CV_32F, cv::Scalar(100)), mono8;
  expose(image, {}, 1, grey, mono8);
  cv::Scalar mean, deviation;
  cv::meanStdDev(mono8, mean, deviation);
  EXPECT_NEAR(mean[0], 100, 0.05);
  EXPECT_NEAR(deviation[0], std::sqrt(9 + 1.0 / 12), 0.04);
}

TEST(Sensor, BlurSpreadsAnEdgeByItsSigma) {
  SimulatedImageParameters image;
  image.noise = 0;
  image.blur = 2;
  cv::Mat grey(20, 40, CV_32F, cv::Scalar(0)), mono8;
  grey.colRange(20, 40).setTo(200);
  expose(image, {}, 1, grey, mono8);
  // A pixel whose centre is one sigma from the edge (between columns 19 and 20) has 84 % of the step.
  const double at_sigma = 0.5 * (mono8.at<uint8_t>(10, 21) + mono8.at<uint8_t>(10, 22));
  EXPECT_NEAR(at_sigma, 0.841 * 200, 3);
}

TEST(Sensor, BrighterThanWhiteIsWhite) {
  SimulatedImageParameters image;
  image.noise = 0;
  cv::Mat grey(4, 4, CV_32F, cv::Scalar(400)), mono8;
  expose(image, {}, 1, grey, mono8);
  EXPECT_EQ(mono8.at<uint8_t>(2, 2), 255);
}

}  // namespace
}  // namespace uav_landing
