#include "faults/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "faults/fault_flight.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

const Fault& fault(const std::string& name) {
  const auto& all = allFaults();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Fault& f) { return f.name == name; });
  if (found == all.end()) throw std::runtime_error("no fault " + name);
  return *found;
}

/// Two frames of uniform grey pictures, 20 m above the ground, looking ahead and 20 degrees down.
class FaultsTest : public testing::Test {
 protected:
  FaultsTest() {
    SimulatorParameters parameters;
    parameters.setPictures(320, 240, 280);
    rig_ = makeCameraRig(parameters).value();
    flight_.rig = &rig_;
    flight_.left = rig_.left.calibration;
    flight_.right = rig_.right.calibration;
    for (const double time : {0.0, 0.05}) {
      Flight::Frame frame;
      frame.time = time;
      frame.pose = {{-200, 0, 20}, {0, -20 * kDegree, 0}};
      frame.left = cv::Mat(240, 320, CV_8U, cv::Scalar(100));
      frame.right = frame.left.clone();
      flight_.frames.push_back(frame);
    }
  }

  Delivery spoiled(const Fault& fault, uint64_t seed = 1) const {
    return spoiled(fault, flight_.frames[1].left, seed);
  }
  Delivery spoiled(const Fault& fault, const cv::Mat& picture, uint64_t seed = 1) const {
    FaultRun run{flight_, 1, cv::RNG(seed)};
    Delivery pair{0.05, picture.clone(), picture.clone(), true};
    fault.spoil(run, 1, pair);
    return pair;
  }

  CameraRig rig_;
  Flight flight_;
};

TEST_F(FaultsTest, EachHasANameOfItsOwnAndDoesSomething) {
  std::set<std::string> names;
  for (const Fault& fault : allFaults()) {
    EXPECT_TRUE(names.insert(fault.name).second) << fault.name;
    EXPECT_FALSE(fault.meaning.empty()) << fault.name;
    EXPECT_TRUE(fault.spoil || fault.calibrate || fault.build || fault.disturb) << fault.name;
  }
  EXPECT_EQ(allFaults()[0].name, "none");
}

TEST_F(FaultsTest, AreFlownWithRigsThatTheChainTakes) {
  Parameters parameters;
  flight_.right.P(1, 3) = 0.01 * flight_.right.P(0, 3);
  const auto flown = [&] { return flyWithFaults(flight_, {&fault("none")}, 1, 1, 1, parameters, {}).alarm; };
  EXPECT_EQ(flown().find("refused"), std::string::npos) << "aslant: " << flown();
  parameters.rig.upside_down = true;
  EXPECT_EQ(flown().find("refused"), std::string::npos) << "and upside down: " << flown();
  flight_.right.P(1, 3) = 0.1 * flight_.right.P(0, 3);
  EXPECT_EQ(flown().rfind("refused: right P[7]", 0), 0u) << flown();
}

TEST_F(FaultsTest, TheChainIsFlownByWhatAFaultTellsIt) {
  // The right images are uniform. The second pair is 50 ms late by its stamp.
  flight_.settled = 0;
  cv::RNG random(1);
  for (Flight::Frame& frame : flight_.frames) random.fill(frame.left, cv::RNG::UNIFORM, 0, 255);
  Fault late = fault("none");
  late.spoil = [](FaultRun&, int frame, Delivery& pair) { pair.time = frame == 0 ? 1.0 : 0.95; };
  const auto seen = [&](const Fault& fault) {
    std::vector<std::string> pairs;
    const FaultObserver observe = [&](double, const LandingResult& said, double, bool) {
      pairs.push_back(said.failure.detail);
    };
    flyWithFaults(flight_, {&fault}, 0, 0, 1, Parameters(), observe);
    return pairs;
  };
  const std::vector<std::string> usual = seen(late);
  ASSERT_EQ(usual.size(), 1u) << "0.05 s is less than max_late";
  EXPECT_EQ(usual[0].rfind("right image has no contrast", 0), 0u) << usual[0];
  late.tell = [](Parameters& told) {
    told.rig.upside_down = true;
    told.rectify.max_late = 0.01;
  };
  const std::vector<std::string> told = seen(late);
  ASSERT_EQ(told.size(), 2u) << "0.05 s is more than max_late, so the clock was set back";
  EXPECT_EQ(told[0].rfind("left image has no contrast", 0), 0u) << told[0];
}

TEST_F(FaultsTest, WhatBuildsOrPaintsASceneIsForTheSimulatorAlone) {
  for (const Fault& fault : allFaults()) {
    if (fault.build || fault.disturb) {
      EXPECT_TRUE(fault.needs_scene) << fault.name;
    }
  }
  // A recording has no camera rig to paint with.
  for (const char* name : {"fog", "snow", "featureless", "repeated_pattern", "taxiway", "shadows", "water"})
    EXPECT_TRUE(fault(name).needs_scene) << name;
  for (const char* name : {"none", "frozen_left", "noise", "bent_yaw_1", "baseline_8", "night"})
    EXPECT_FALSE(fault(name).needs_scene) << name;
}

TEST_F(FaultsTest, WhatIsPaintedHasNoiseOfOneGreyLevelInEachPictureOfItsOwn) {
  int painted = 0;
  for (const Fault& fault : allFaults()) {
    if (!fault.needs_scene || !fault.spoil) continue;
    SCOPED_TRACE(fault.name);
    ++painted;
    const Delivery one = spoiled(fault, 1), other = spoiled(fault, 2);
    cv::Mat left, right, across;
    cv::subtract(one.left, other.left, left, cv::noArray(), CV_32F);
    cv::subtract(one.right, other.right, right, cv::noArray(), CV_32F);
    // The difference of two, each rounded to whole grey levels.
    const double expected = std::sqrt(2 * (1 + 1.0 / 12));
    for (const cv::Mat& difference : {left, right}) {
      cv::Scalar mean, deviation;
      cv::meanStdDev(difference, mean, deviation);
      EXPECT_NEAR(deviation[0], expected, 0.1);
    }
    EXPECT_LT(std::abs(left.dot(right)) / (cv::norm(left) * cv::norm(right)), 0.02) << "noise in common";
  }
  EXPECT_EQ(painted, 7);
}

TEST_F(FaultsTest, VibrationBeginsInFlightAndRowsAreThereAllTheTime) {
  for (const char* name : {"vibration", "vibration_rows"}) {
    SCOPED_TRACE(name);
    EXPECT_FALSE(fault(name).wholeRun());
    SimulatorParameters changed;
    fault(name).disturb(changed, 1.5);
    EXPECT_EQ(changed.vibration.start, 1.5);
    EXPECT_GT(changed.vibration.pitch_deg, 0);
    EXPECT_EQ(changed.image.readout_time > 0, std::string(name) == "vibration_rows");
  }
  SimulatorParameters untold;
  fault("readout_untold").build(untold);
  EXPECT_EQ(untold.image.readout_time, 0.01);
  EXPECT_TRUE(fault("readout_untold").wholeRun());
}

TEST_F(FaultsTest, ReadoutTimeIsToldShorterThanItIsByAThird) {
  SimulatorParameters scene;
  Parameters parameters;
  fault("readout_told").build(scene);
  fault("readout_told").tell(parameters);
  EXPECT_NEAR(parameters.rig.readout_time, scene.image.readout_time * 2 / 3, 1e-12);
  SimulatorParameters shaken;
  Parameters right;
  fault("vibration_rows").disturb(shaken, 1);
  fault("vibration_rows").tell(right);
  EXPECT_EQ(right.rig.readout_time, shaken.image.readout_time);
}

TEST_F(FaultsTest, WaterMirrorsTheSkyFromItsShoreOnAndLeavesTheRestAsItWas) {
  const cv::Mat picture = spoiled(fault("water")).left;
  // Its shore is 15 m and three heights ahead, on the ground.
  const Eigen::Matrix3d axes = runwayFromOptical(flight_.frames[1].pose.attitude);
  const auto rowOf = [&](double ahead) {
    const Eigen::Vector3d seen = axes.transpose() * Eigen::Vector3d(ahead, 0, -20);
    return static_cast<int>(
        std::lround(rig_.left.calibration.K(1, 2) + rig_.left.calibration.K(1, 1) * seen.y() / seen.z()));
  };
  const int shore = rowOf(75), horizon = rowOf(1e6);
  ASSERT_GT(shore, horizon + 10);
  ASSERT_LT(shore, 200);
  const auto changed = [&](int from, int to) {
    return cv::norm(picture.rowRange(from, to), cv::Mat(to - from, 320, CV_8U, cv::Scalar(100)),
                    cv::NORM_L1) /
           ((to - from) * 320);
  };
  EXPECT_GT(changed(horizon + 2, shore - 2), 20);
  EXPECT_LT(changed(shore + 2, 240), 1) << "noise";
  if (horizon > 5) {
    EXPECT_LT(changed(0, horizon - 2), 1) << "noise";
  }
}

TEST_F(FaultsTest, WhatTakesStereoAwayLeavesTheLeftPictureAsItWas) {
  cv::Mat picture(240, 320, CV_8U, cv::Scalar(60));
  picture.colRange(160, 320).setTo(160);
  for (const char* name : {"black_right", "fogged_right", "copied_right"})
    EXPECT_EQ(cv::norm(spoiled(fault(name), picture).left, picture, cv::NORM_INF), 0) << name;
  EXPECT_EQ(cv::countNonZero(spoiled(fault("black_right"), picture).right), 0);
  // A third of the contrast far from the edge, and a tenth of that across 2 px of it.
  const cv::Mat fogged = spoiled(fault("fogged_right"), picture).right;
  const auto mean = [&](int column) { return cv::mean(fogged.col(column))[0]; };
  EXPECT_NEAR(mean(300) - mean(20), 30, 1);
  EXPECT_LT(mean(161) - mean(158), 6);
  EXPECT_EQ(cv::norm(spoiled(fault("copied_right"), picture).right, picture, cv::NORM_INF), 0);
}

TEST_F(FaultsTest, ABentCameraSeesEverythingTurnedByItsAngle) {
  // A spot in the middle of the picture.
  cv::Mat picture(240, 320, CV_8U, cv::Scalar(0));
  const Eigen::Matrix3d& K = flight_.right.K;
  const cv::Point2d middle(std::lround(K(0, 2)), std::lround(K(1, 2)));
  cv::circle(picture, middle, 6, cv::Scalar(200), cv::FILLED);
  const auto spotIn = [](const cv::Mat& image) {
    const cv::Moments moments = cv::moments(image);
    return cv::Point2d(moments.m10 / moments.m00, moments.m01 / moments.m00);
  };
  for (const double degrees : {0.2, 1.0}) {
    const std::string size = degrees == 1 ? "1" : "0.2";
    const Delivery yaw = spoiled(fault("bent_yaw_" + size), picture);
    EXPECT_NEAR(spotIn(yaw.right).x - middle.x, -K(0, 0) * std::tan(degrees * kDegree), 0.1) << size;
    EXPECT_NEAR(spotIn(yaw.right).y, middle.y, 0.1) << size;
    EXPECT_EQ(cv::norm(yaw.left, picture, cv::NORM_INF), 0) << "the left camera stays";
    const Delivery pitch = spoiled(fault("bent_pitch_" + size), picture);
    EXPECT_NEAR(spotIn(pitch.right).x, middle.x, 0.1) << size;
    EXPECT_NEAR(spotIn(pitch.right).y - middle.y, K(1, 1) * std::tan(degrees * kDegree), 0.1) << size;
  }
}

}  // namespace
}  // namespace uav_landing
