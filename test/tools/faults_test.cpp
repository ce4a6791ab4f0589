#include "faults/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

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
    const FaultObserver observe = [&](double, const LandingResult& said, const FaultTruth&, bool) {
      pairs.push_back(said.failure.detail);
    };
    flyWithFaults(flight_, {&fault}, 0, 0, 1, Parameters(), observe);
    return pairs;
  };
  const std::vector<std::string> usual = seen(late);
  ASSERT_EQ(usual.size(), 1u) << "0.05 s is less than max_late";
  EXPECT_EQ(usual[0].rfind("right image has no contrast", 0), 0u) << usual[0];
  late.tell = [](Parameters& told, const Flight&) {
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
  for (const char* name : {"fog", "snow", "featureless", "repeated_pattern", "taxiway", "shadows", "water",
                           "wet_runway", "lamps", "half_runway"})
    EXPECT_TRUE(fault(name).needs_scene) << name;
  for (const char* name :
       {"none", "frozen_left", "noise", "bent_yaw_1", "baseline_8", "night", "video", "rain"})
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
  EXPECT_EQ(painted, 11);
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

TEST_F(FaultsTest, EveryFourthPairChangesPlacesWithTheOneBehindIt) {
  // Six pairs, of which each has its number as grey level and as tenths of a second.
  flight_.frames.resize(6, flight_.frames[0]);
  for (int i = 0; i < 6; ++i) {
    Flight::Frame& frame = flight_.frames[static_cast<size_t>(i)];
    frame.time = 0.1 * i;
    frame.left = cv::Mat(2, 2, CV_8U, cv::Scalar(i));
    frame.right = cv::Mat(2, 2, CV_8U, cv::Scalar(10 + i));
  }
  FaultRun run{flight_, 0, cv::RNG(1)};
  const int expected[] = {1, 0, 2, 3, 5, 4};
  for (int i = 0; i < 6; ++i) {
    const Flight::Frame& own = flight_.frames[static_cast<size_t>(i)];
    Delivery pair{own.time, own.left.clone(), own.right.clone(), true};
    fault("out_of_order").spoil(run, i, pair);
    EXPECT_DOUBLE_EQ(pair.time, 0.1 * expected[i]) << i;
    EXPECT_EQ(pair.left.at<uchar>(0, 0), expected[i]) << i;
    EXPECT_EQ(pair.right.at<uchar>(0, 0), 10 + expected[i]) << i;
  }
}

TEST_F(FaultsTest, TheCameraInfoOfTheLeftCameraForBothKeepsTheBaseline) {
  CameraCalibration left = flight_.left, right = flight_.right;
  fault("camera_info").calibrate(left, right);
  EXPECT_EQ(right.P(0, 3), flight_.right.P(0, 3));
  EXPECT_NE(right.P(0, 3), 0);
  EXPECT_EQ(right.K, flight_.left.K);
  EXPECT_EQ(left.K(0, 2), flight_.left.K(0, 2) + 8);
}

TEST(ThresholdFlights, PassTheThresholdInTheLaterHalf) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    const SimulatorParameters p = drawThresholdFlight(seed, 110, Parameters());
    const double way = p.path.speed * std::cos(p.path.glide_angle_deg * M_PI / 180) * p.path.duration;
    EXPECT_LE(p.path.start_x + 0.5 * way, 1e-9) << seed;
    EXPECT_GE(p.path.start_x + 0.8 * way, -1e-9) << seed;
    EXPECT_EQ(p.image.width, 640);
  }
  EXPECT_NE(drawThresholdFlight(1, 110, Parameters()).path.start_x,
            drawThresholdFlight(2, 110, Parameters()).path.start_x);
}

TEST_F(FaultsTest, TheClocksOfTheCamerasDriftApartFromTheOnsetOn) {
  SimulatorParameters changed;
  fault("clock_drift").disturb(changed, 1.5);
  EXPECT_EQ(changed.right_camera.clock_drift, 0.005);
  EXPECT_EQ(changed.right_camera.clock_drift_start, 1.5);
  EXPECT_EQ(changed.left_camera.clock_drift, 0);
}

TEST_F(FaultsTest, ReadoutTimeIsToldShorterThanItIsByAThird) {
  SimulatorParameters scene;
  Parameters parameters;
  fault("readout_told").build(scene);
  fault("readout_told").tell(parameters, flight_);
  EXPECT_NEAR(parameters.rig.readout_time, scene.image.readout_time * 2 / 3, 1e-12);
  SimulatorParameters shaken;
  Parameters right;
  fault("vibration_rows").disturb(shaken, 1);
  fault("vibration_rows").tell(right, flight_);
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

/// A picture with something to see everywhere.
cv::Mat texture(uint64_t seed) {
  cv::Mat picture(240, 320, CV_8U);
  cv::RNG(seed).fill(picture, cv::RNG::UNIFORM, 60, 180);
  cv::GaussianBlur(picture, picture, cv::Size(), 2);
  return picture;
}

double meanDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

/// More frames, of a texture that changes from each to the next.
class StreamFaultsTest : public FaultsTest {
 protected:
  StreamFaultsTest() {
    flight_.frames.clear();
    for (int i = 0; i < 45; ++i) {
      Flight::Frame frame;
      frame.time = 0.05 * i;
      frame.left = texture(static_cast<uint64_t>(2 * i + 1));
      frame.right = texture(static_cast<uint64_t>(2 * i + 2));
      flight_.frames.push_back(frame);
    }
  }

  Delivery spoiledAt(const std::string& name, int frame, int onset = 0, uint64_t seed = 1) const {
    FaultRun run{flight_, onset, cv::RNG(seed), seed};
    const Flight::Frame& source = flight_.frames[static_cast<size_t>(frame)];
    Delivery pair{source.time, source.left.clone(), source.right.clone(), true};
    fault(name).spoil(run, frame, pair);
    return pair;
  }
  const cv::Mat& left(int frame) const { return flight_.frames[static_cast<size_t>(frame)].left; }
  const cv::Mat& right(int frame) const { return flight_.frames[static_cast<size_t>(frame)].right; }
};

TEST_F(StreamFaultsTest, AKeyFrameOfAVideoIsBetterThanTheOthers) {
  const double key = meanDifference(spoiledAt("video", 23, 3).left, left(23));
  const double other = meanDifference(spoiledAt("video", 22, 3).left, left(22));
  EXPECT_GT(key, 0);
  EXPECT_GT(other, 1.5 * key);
}

TEST_F(StreamFaultsTest, ALostImageLeavesAGhostUntilTheNextKeyFrame) {
  const auto lostLeft = [&](int frame) {
    const Delivery loss = spoiledAt("video_loss", frame), video = spoiledAt("video", frame);
    return meanDifference(loss.left, video.left);
  };
  for (const int frame : {4, 20, 24}) EXPECT_EQ(lostLeft(frame), 0) << frame;
  for (const int frame : {5, 6, 19, 25, 39}) EXPECT_GT(lostLeft(frame), 3) << frame;
  // At the moment itself the decoder repeats the image before.
  const cv::Mat repeated = spoiledAt("video_loss", 5).left;
  EXPECT_LT(meanDifference(repeated, left(4)), 0.5 * meanDifference(repeated, left(5)));
  EXPECT_EQ(meanDifference(spoiledAt("video_loss", 6).right, spoiledAt("video", 6).right), 0);
}

TEST_F(StreamFaultsTest, ATornImageIsOfThePairBeforeDownToARow) {
  const Delivery pair = spoiledAt("torn", 7);
  EXPECT_EQ(cv::norm(pair.left.rowRange(0, 40), left(6).rowRange(0, 40), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(pair.left.rowRange(200, 240), left(7).rowRange(200, 240), cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(pair.right, right(7), cv::NORM_INF), 0);
}

TEST_F(StreamFaultsTest, WhatIsWrongWithASensorStaysWhereItIs) {
  for (const char* name : {"dead_rows", "stuck_pixels"}) {
    cv::Mat first, second;
    cv::subtract(spoiledAt(name, 3).right, right(3), first, cv::noArray(), CV_16S);
    cv::subtract(spoiledAt(name, 9).right, right(9), second, cv::noArray(), CV_16S);
    EXPECT_GT(cv::countNonZero(first), 900) << name;
    EXPECT_LT(cv::countNonZero((first != 0) != (second != 0)), 200) << name;
    cv::Mat other;
    cv::subtract(spoiledAt(name, 3, 0, 5).right, right(3), other, cv::noArray(), CV_16S);
    EXPECT_GT(cv::countNonZero((first != 0) != (other != 0)), 200) << name << ": the same on every flight";
  }
}

TEST_F(StreamFaultsTest, ExposuresSwingAboutTheRightOne) {
  double least = 9, most = 0, apart = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const Delivery pair = spoiledAt("exposure_pump", frame);
    const double gain = cv::mean(pair.left)[0] / cv::mean(left(frame))[0];
    least = std::min(least, gain);
    most = std::max(most, gain);
    apart = std::max(apart, std::abs(gain - cv::mean(pair.right)[0] / cv::mean(right(frame))[0]));
  }
  EXPECT_NEAR(least, 0.4, 0.02);
  EXPECT_NEAR(most, 1.6, 0.03);
  EXPECT_GT(apart, 0.2) << "the cameras swing together";
}

TEST_F(StreamFaultsTest, DropsRunDownTheLensAndInsectsStay) {
  const auto touched = [&](const char* name, int frame) {
    const Delivery pair = spoiledAt(name, frame);
    cv::Mat difference;
    if (std::string(name) == "rain")
      cv::absdiff(pair.left, left(frame), difference);
    else
      cv::absdiff(pair.right, right(frame), difference);
    return cv::Mat(difference > 8);
  };
  const cv::Mat early = touched("insects", 2), late = touched("insects", 42);
  EXPECT_GT(cv::countNonZero(late), 1.5 * cv::countNonZero(early));
  EXPECT_GT(cv::countNonZero(early & late), 0.7 * cv::countNonZero(early)) << "they do not move";
  const cv::Mat wet = touched("rain", 0), later = touched("rain", 42);
  EXPECT_GT(cv::countNonZero(wet), 1000);
  EXPECT_GT(cv::countNonZero(later), 500);
  EXPECT_LT(cv::countNonZero(wet & later), 0.6 * cv::countNonZero(wet));
}

TEST_F(StreamFaultsTest, WaterCondensesMoreAndMoreAndOnAFlightOfItsOwnShare) {
  for (Flight::Frame& frame : flight_.frames) {
    frame.left.setTo(60);
    frame.left.colRange(160, 320).setTo(160);
  }
  // Far from the edge the blur changes nothing. 0.7 of the contrast is lost within a minute.
  const auto share = [&](int frame, uint64_t seed) {
    const cv::Mat picture = spoiledAt("condensation", frame, 0, seed).left;
    return (1 - (cv::mean(picture.col(300))[0] - cv::mean(picture.col(20))[0]) / 100) / 0.7;
  };
  double least = 1, most = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    EXPECT_NEAR(share(44, seed) - share(0, seed), 2.2 / 60, 0.03) << "whole grey levels";
    EXPECT_GT(share(44, seed), share(0, seed));
    least = std::min(least, share(0, seed));
    most = std::max(most, share(0, seed));
  }
  EXPECT_LT(least, 0.4);
  EXPECT_GT(most, 0.6);
}

TEST_F(FaultsTest, ALensThatWasHitShowsAllTwoPixelsAside) {
  cv::Mat picture(240, 320, CV_8U, cv::Scalar(0));
  cv::circle(picture, {150, 120}, 6, cv::Scalar(200), cv::FILLED);
  const Delivery pair = spoiled(fault("lens_hit"), picture);
  const cv::Moments moments = cv::moments(pair.left);
  EXPECT_NEAR(std::hypot(moments.m10 / moments.m00 - 150, moments.m01 / moments.m00 - 120), 2, 0.1);
  EXPECT_EQ(cv::norm(pair.right, picture, cv::NORM_INF), 0);
}

TEST_F(FaultsTest, ARigThatWarmsUpBendsByAFewHundredthsOfADegree) {
  cv::Mat picture(240, 320, CV_8U, cv::Scalar(0));
  cv::circle(picture, {60, 60}, 6, cv::Scalar(200), cv::FILLED);
  double furthest = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    FaultRun run{flight_, 0, cv::RNG(seed), seed};
    Delivery pair{0.05, picture.clone(), picture.clone(), true};
    fault("bent_warm").spoil(run, 1, pair);
    const cv::Moments moments = cv::moments(pair.right);
    const double moved = std::hypot(moments.m10 / moments.m00 - 60, moments.m01 / moments.m00 - 60);
    EXPECT_LT(moved, 1.2 * 280 * std::tan(0.1 * kDegree)) << seed;
    furthest = std::max(furthest, moved);
  }
  EXPECT_GT(furthest, 280 * std::tan(0.03 * kDegree));
}

TEST_F(FaultsTest, BladesAndAWiperCoverAnotherPlaceInEachImage) {
  flight_.frames.push_back(flight_.frames[1]);
  flight_.frames[2].time = 0.1;
  const cv::Mat picture(240, 320, CV_8U, cv::Scalar(100));
  for (const char* name : {"propeller", "wiper"}) {
    std::vector<cv::Mat> dark;
    for (const int frame : {0, 1, 2}) {
      FaultRun run{flight_, 0, cv::RNG(1), 1};
      Delivery pair{0.05 * frame, picture.clone(), picture.clone(), true};
      fault(name).spoil(run, frame, pair);
      dark.push_back(pair.left < 90);
    }
    EXPECT_GT(cv::countNonZero(dark[0] | dark[1] | dark[2]), 1000) << name;
    EXPECT_GT(cv::countNonZero(dark[0] != dark[1]) + cv::countNonZero(dark[1] != dark[2]), 1000) << name;
  }
}

TEST_F(FaultsTest, SandAndLampsAreAtTheRunwaysWidth) {
  flight_.runway_width = 30;
  flight_.frames[1].pose = {{100, 0, 20}, {0, -20 * kDegree, 0}};
  const cv::Mat before = flight_.frames[1].left;
  const auto changed = [&](const char* name, double y) {
    const cv::Mat picture = spoiled(fault(name)).left;
    double most = 0;
    // Along a line on the ground, 45 to 105 m ahead.
    for (double ahead = 45; ahead < 105; ahead += 0.5) {
      const Eigen::Matrix3d axes = runwayFromOptical(flight_.frames[1].pose.attitude);
      const Eigen::Vector3d seen = axes.transpose() * Eigen::Vector3d(ahead, y, -20);
      const Eigen::Vector3d pixel = rig_.left.calibration.K * seen / seen.z();
      const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
      if (!cv::Rect({}, picture.size()).contains(at)) continue;
      most = std::max(most, std::abs(double(picture.at<uchar>(at)) - before.at<uchar>(at)));
    }
    return most;
  };
  Parameters parameters;
  fault("half_runway_told").tell(parameters, flight_);
  EXPECT_EQ(parameters.runway.width, 30);
  EXPECT_GT(changed("half_runway", 8), 8);
  EXPECT_LT(changed("half_runway", -8), 6) << "noise";
  EXPECT_GT(changed("lamps", 16.5), 20);
  EXPECT_GT(changed("lamps", -16.5), 20);
  EXPECT_LT(changed("lamps", 5), 6) << "noise";
  EXPECT_GT(changed("wet_runway", 0), 8);
  EXPECT_LT(changed("wet_runway", 25), 6) << "noise";
}

}  // namespace
}  // namespace uav_landing
