#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/stamp_map.h"
#include "support/rolling_camera.h"
#include "uav_landing/pipeline.h"

namespace uav_landing {
namespace {

constexpr double kReadout = 0.03, kPeriod = 0.05;  // s

struct Errors {
  double angle = 0, height = 0, pitch = 0;  // rad, share, rad: means of the last pairs
  int count = 0;
};

/// The chain over what a rolling shutter of 30 ms sees; given: what it is told of it.
Errors errorsOf(double readout, double given) {
  constexpr int kPairs = 9, kFirst = 5;
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  Parameters parameters;
  parameters.rig.readout_time = given;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  Errors errors;
  for (int i = 0; i < kPairs; ++i) {
    const double stamp = i * kPeriod;
    const Pipeline::Output& output = pipeline.process(stamp, test::rollingImage(ground, rig, stamp, readout),
                                                      test::rollingImage(ground, rig, stamp, readout, true));
    if (i < kFirst || output.approach.step.failure || output.stereo.failure) continue;
    const test::Pose now = test::movingPose(stamp);
    errors.angle += output.approach.step.angle - test::Movement(test::movingPose(stamp - kPeriod), now).angle;
    errors.height += output.stereo.plane.height() / now.height() - 1;
    errors.pitch += pitchOf(output.stereo.plane.normal()) - now.pitch;
    ++errors.count;
  }
  errors.angle /= errors.count;
  errors.height /= errors.count;
  errors.pitch /= errors.count;
  return errors;
}

TEST(RollingShutter, LeavesTheEstimatesAsTheyAreWhenItsReadoutTimeIsKnown) {
  const Errors global = errorsOf(0, 0), known = errorsOf(kReadout, kReadout), ignored = errorsOf(kReadout, 0);
  ASSERT_EQ(known.count, 4);
  ASSERT_EQ(global.count, 4);
  EXPECT_LT(std::abs(known.angle), 0.05 * test::kDegree) << global.angle / test::kDegree;
  EXPECT_LT(std::abs(known.height), 2e-3) << global.height;
  EXPECT_LT(std::abs(known.pitch), 0.04 * test::kDegree) << global.pitch / test::kDegree;
  EXPECT_GT(std::abs(ignored.angle) + std::abs(ignored.pitch), 0.1 * test::kDegree)
      << "the shutter must matter";
}

/// Largest errors over their claimed standard deviations.
struct Ratios {
  double angle = 0, published_angle = 0, height = 0, time = 0;
  double largest_stddev = 0;          // of the published angle, rad
  double found = 0, time_stddev = 0;  // s, of the last pair
  int count = 0, shaken = 0;          // pairs; those of which row_motion fails
};

test::Pose steadyPose(double t) { return test::movingPose(t); }

/// The same path in gusts: turns by up to 9 degrees a second while rows are read.
test::Pose gustyPose(double t) {
  test::Pose pose = test::movingPose(t);
  pose.pitch += 1.0 * test::kDegree * std::sin(2 * M_PI * 1.5 * t);
  pose.roll += 1.5 * test::kDegree * std::sin(2 * M_PI * 0.8 * t);
  return pose;
}

/// The same path while the rig vibrates about its pitch axis.
test::Pose pitchingPose(double t, double degrees, double hertz) {
  test::Pose pose = test::movingPose(t);
  pose.pitch += degrees * test::kDegree * std::sin(2 * M_PI * hertz * t);
  return pose;
}

test::Pose vibratingPose(double t) { return pitchingPose(t, 0.15, 47); }

/// Vibration too slow and too weak to be told from a motion within an image.
test::Pose weaklyVibratingPose(double t) { return pitchingPose(t, 0.03, 27); }

/// The same near twice the frame rate. Images that follow each other see nearly the same phase of it.
test::Pose aliasedPose(double t) { return pitchingPose(t, 0.03, 42); }

test::Pose stronglyVibratingPose(double t) {
  test::Pose pose = pitchingPose(t, 0.4, 70);
  pose.roll += 0.4 * test::kDegree * std::sin(2 * M_PI * 50 * t);
  return pose;
}

/// What the chain is told of the shutter.
enum class Told { kNothing, kToEstimate, kAll };

Ratios ratiosOf(double readout, Told told = Told::kToEstimate, test::Pose (*poseAt)(double) = steadyPose) {
  constexpr int kPairs = 32;
  // The first half second tells how the gusts are.
  const int first = told == Told::kAll ? 10 : 6;
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  Parameters parameters;
  parameters.rig.estimate_readout_time = told == Told::kToEstimate;
  if (told == Told::kAll) parameters.rig.readout_time = readout;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  Ratios ratios;
  for (int i = 0; i < kPairs; ++i) {
    const double stamp = i * kPeriod;
    const Pipeline::Output& output =
        pipeline.process(stamp, test::rollingImage(poseAt, ground, rig, stamp, readout),
                         test::rollingImage(poseAt, ground, rig, stamp, readout, true));
    const ReadoutEstimate& found = output.approach.readout;
    ratios.found = found.time;
    ratios.time_stddev = std::sqrt(found.variance);
    if (i < first || output.approach.step.failure || !std::isfinite(output.landing.raw_height)) continue;
    if (readout != 0 && told != Told::kAll && !found.known()) continue;  // nothing has been seen of it yet
    const test::Pose now = poseAt(stamp);
    const auto take = [](double error, double variance, double& largest) {
      largest = std::max(largest, std::abs(error) / std::sqrt(variance));
    };
    const ApproachAngleResult::Motion& step = output.approach.step;
    take(step.angle - test::Movement(poseAt(stamp - kPeriod), now).angle, step.angle_variance, ratios.angle);
    const ApproachAngleResult::Motion& window = output.approach.window;
    take(window.angle - test::Movement(poseAt(stamp - 1e-3), now).angle, window.angle_variance,
         ratios.published_angle);
    ratios.largest_stddev = std::max(ratios.largest_stddev, std::sqrt(window.angle_variance));
    take(output.landing.raw_height - now.height(), output.landing.raw_height_variance, ratios.height);
    if (found.known()) take(found.time - readout, found.variance, ratios.time);
    ++ratios.count;
    for (const TestResult& test : output.landing.tests)
      ratios.shaken += test.name == "row_motion" && test.failed();
  }
  return ratios;
}

void expectClaimed(const Ratios& ratios, double readout) {
  EXPECT_LT(ratios.height, 3) << readout;
  EXPECT_LT(ratios.time, 3) << readout;
  EXPECT_LT(ratios.time_stddev, 0.015) << readout;
  EXPECT_GT(ratios.time_stddev, 1e-3) << readout;
}

TEST(RollingShutter, ThatNobodyToldOfIsClaimedAndFound) {
  for (const double readout : {0.0, kReadout, -0.02}) {
    const Ratios ratios = ratiosOf(readout);
    ASSERT_GT(ratios.count, 5);
    EXPECT_LT(ratios.angle, 3) << readout;
    EXPECT_LE(std::abs(ratios.found), std::abs(readout)) << readout;
    expectClaimed(ratios, readout);
  }
  EXPECT_GT(ratiosOf(kReadout).found, 0.2 * kReadout);
}

TEST(RollingShutter, ThatNobodyToldOfIsSeenByItsRowsAndThenEstimated) {
  for (const double readout : {kReadout, -kReadout}) {
    const Ratios ratios = ratiosOf(readout, Told::kNothing, gustyPose);
    ASSERT_GT(ratios.count, 5);
    EXPECT_GT(ratios.found / readout, 0.2) << readout;
    EXPECT_EQ(ratios.shaken, 0) << "only the pairs before the estimate";
    expectClaimed(ratios, readout);
  }
  const Ratios global = ratiosOf(0, Told::kNothing, gustyPose);
  EXPECT_EQ(global.found, 0);
  EXPECT_EQ(global.time_stddev, 0) << "taken as global: nothing speaks against it";
  EXPECT_LT(global.angle, 3);
}

TEST(RollingShutter, IsClaimedInGustsWhenItsReadoutTimeIsKnown) {
  for (const double readout : {kReadout, -kReadout}) {
    const Ratios ratios = ratiosOf(readout, Told::kAll, gustyPose);
    ASSERT_GT(ratios.count, 20);
    EXPECT_LT(ratios.angle, 3) << readout;
    EXPECT_LT(ratios.published_angle, 3) << readout;
    EXPECT_LT(ratios.largest_stddev, 0.2 * test::kDegree) << readout;
    EXPECT_LT(ratios.height, 3) << readout;
    EXPECT_EQ(ratios.shaken, 0) << readout;
  }
}

TEST(RollingShutter, WidensTheClaimsOfHeightsUnderVibration) {
  const Ratios ratios = ratiosOf(kReadout, Told::kAll, vibratingPose);
  ASSERT_GT(ratios.count, 20);
  EXPECT_EQ(ratios.shaken, ratios.count) << "the vibration must be seen";
  EXPECT_LT(ratios.height, 3);
}

TEST(RollingShutter, ClaimsWhatVibrationDoesThatNoImageShows) {
  for (const auto poseAt : {weaklyVibratingPose, aliasedPose}) {
    const Ratios ratios = ratiosOf(0.008, Told::kAll, poseAt);
    ASSERT_GT(ratios.count, 20);
    EXPECT_EQ(ratios.shaken, 0) << "it must not be seen";
    EXPECT_LT(ratios.published_angle, 3);
    EXPECT_LT(ratios.largest_stddev, 3 * test::kDegree);
  }
}

TEST(RollingShutter, OneBadImageDisturbsLittleLongerThanItIsInTheWindow) {
  // The first two images are those of the first step and of all windows up to pair 11.
  constexpr int kPairs = 24, kBad = 1, kLast = 11, kSettled = 17;
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  Parameters parameters;
  parameters.rig.readout_time = kReadout;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  int shaken = 0;
  for (int i = 0; i < kPairs; ++i) {
    const double stamp = i * kPeriod;
    test::Pose (*poseAt)(double) = i <= kBad ? stronglyVibratingPose : steadyPose;
    const ApproachAngleResult::Motion motion =
        pipeline
            .process(stamp, test::rollingImage(poseAt, ground, rig, stamp, kReadout),
                     test::rollingImage(poseAt, ground, rig, stamp, kReadout, true))
            .approach.window;
    shaken += motion.rowsMove();
    if (i > kLast) {
      EXPECT_FALSE(motion.rowsMove()) << i;
    }
    if (i >= kSettled) {
      EXPECT_LT(std::sqrt(motion.angle_variance), 0.1 * test::kDegree) << i;
    }
  }
  EXPECT_GT(shaken, 2) << "they must be seen to shake";
}

// Turns must not be taken out of one image and left in the other, at the ends of the step or of the window.
TEST(RollingShutter, BearsAGyroscopeThatMissesAnImage) {
  constexpr int kPairs = 36, kMissed = 24, kLearned = 12;
  // At twice the frame rate both images shake alike.
  const auto poseAt = [](double t) { return pitchingPose(t, 0.1, 40); };
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  Parameters parameters;
  parameters.rig.readout_time = 0.01;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  for (int i = 0; i < kPairs; ++i) {
    const double stamp = i * kPeriod;
    AttitudePrior imu;
    if (i != kMissed) imu.rows = test::gyroRows(stamp, poseAt);
    const ApproachAngleResult result =
        pipeline
            .process(stamp, test::rollingImage(poseAt, ground, rig, stamp, 0.01),
                     test::rollingImage(poseAt, ground, rig, stamp, 0.01, true), 0, imu)
            .approach;
    if (i < kLearned) continue;
    for (const ApproachAngleResult::Motion& motion : {result.step, result.window}) {
      ASSERT_FALSE(motion.failure) << i << ": " << motion.failure.message();
      const double before = &motion == &result.step ? kPeriod : 1e-3;
      const double truth = test::Movement(poseAt(stamp - before), poseAt(stamp)).angle;
      EXPECT_LT(std::abs(motion.angle - truth), 3 * std::sqrt(motion.angle_variance)) << i;
    }
  }
}

TEST(RollingShutter, ThatWasSeenIsForgottenAtAReset) {
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  const RigModel model = makeRigModel(test::calibrationOf(rig), test::calibrationOf(rig, true)).value();
  StereoDepthStage stereo(model, {});
  ApproachAngleStage approach(model, {});
  const auto readoutAt = [&](double stamp) {
    const cv::Mat left = test::rollingImage(gustyPose, ground, rig, stamp, kReadout),
                  right = test::rollingImage(gustyPose, ground, rig, stamp, kReadout, true);
    return approach.process(stamp, left, right, stereo.process(stamp, left, right)).readout;
  };
  ReadoutEstimate last;
  for (int i = 0; i < 32; ++i) last = readoutAt(i * kPeriod);
  EXPECT_TRUE(last.known());
  approach.reset();
  const ReadoutEstimate first = readoutAt(32 * kPeriod);
  EXPECT_FALSE(first.known());
  EXPECT_FALSE(first.given());
}

TEST(RollingShutter, IsEstimatedWhereItIsAskedForAndNotGiven) {
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const cv::Mat image = test::GroundRenderer(12).left(rig, test::movingPose(0));
  for (const bool given : {false, true}) {
    for (const bool asked : {false, true}) {
      Parameters parameters;
      if (given) parameters.rig.readout_time = 0;
      parameters.rig.estimate_readout_time = asked;
      Pipeline pipeline =
          Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
      const ReadoutEstimate& readout = pipeline.process(0, image, image).approach.readout;
      EXPECT_EQ(readout.known(), asked && !given);
      EXPECT_EQ(readout.given(), given);
    }
  }
}

TEST(RollingShutter, StereoTellsHowFastThePlaneMovesByThePairsBefore) {
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  for (const bool given : {true, false}) {
    Parameters parameters;
    if (given) parameters.rig.readout_time = kReadout;
    parameters.rig.estimate_readout_time = !given;
    Pipeline pipeline =
        Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
    Eigen::Vector3d rate, wanted;
    for (int i = 0; i < 6; ++i) {
      const double stamp = i * kPeriod;
      const test::Pose now = test::movingPose(stamp);
      rate = pipeline
                 .process(stamp, test::rollingImage(ground, rig, stamp, kReadout),
                          test::rollingImage(ground, rig, stamp, kReadout, true))
                 .stereo.plane_rate;
      wanted = planeRate(PlaneVector(now.down() / now.height()), test::motionAt(stamp));
    }
    EXPECT_LT((rate - wanted).norm(), 0.2 * wanted.norm()) << rate.transpose() << " / " << wanted.transpose();
  }
}

/// Of the pairs from the tenth on.
struct Angles {
  double least_variance = 100, largest_variance = 0;
  int pairs = 0, failed = 0;  ///< with an angle; with rows that the test finds to move it too much
  int heights = 0;            ///< that are valid
};

/// vibration: of the pitch, rad. told: of the readout time.
Angles anglesWith(double vibration, bool told = true) {
  constexpr int kPairs = 20, kFirst = 10;
  constexpr double kFrequency = 37;  // Hz
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  const test::GroundRenderer ground(12);
  const auto poseAt = [&](double t) {
    test::Pose pose = test::movingPose(t);
    pose.pitch += vibration * std::sin(2 * M_PI * kFrequency * t);
    return pose;
  };
  Parameters parameters;
  if (told) parameters.rig.readout_time = kReadout;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  Angles angles;
  for (int i = 0; i < kPairs; ++i) {
    const double stamp = i * kPeriod;
    const Pipeline::Output& output =
        pipeline.process(stamp, test::rollingImage(poseAt, ground, rig, stamp, kReadout),
                         test::rollingImage(poseAt, ground, rig, stamp, kReadout, true));
    if (i < kFirst || output.approach.window.failure) continue;
    const double variance = output.approach.window.angle_variance;
    angles.least_variance = std::min(angles.least_variance, variance);
    angles.largest_variance = std::max(angles.largest_variance, variance);
    ++angles.pairs;
    angles.heights += output.landing.height_valid;
    for (const TestResult& test : output.landing.tests)
      angles.failed += test.name == "row_motion" && test.failed();
  }
  return angles;
}

TEST(RollingShutter, ThatShakesTellsNoAngle) {
  const Angles shaken = anglesWith(0.1 * test::kDegree);
  EXPECT_EQ(shaken.least_variance, 1) << "1 rad: nothing is known";
  EXPECT_EQ(shaken.largest_variance, 1);
  EXPECT_GT(shaken.pairs, 5);
  EXPECT_EQ(shaken.failed, shaken.pairs);
  EXPECT_EQ(shaken.heights, shaken.pairs) << "stereo needs no motion";
  const Angles untold = anglesWith(0.1 * test::kDegree, false);
  EXPECT_GT(untold.pairs, 5);
  EXPECT_GE(untold.failed, untold.pairs - 1) << "one pair at which the estimate begins";
  const Angles still = anglesWith(0);
  EXPECT_LT(still.largest_variance, 1e-3);
  EXPECT_EQ(still.failed, 0);
}

TEST(RollingShutter, OfTheRightCameraAloneIsSkew) {
  RigModel model = test::makeModel(test::makeRig(320, 240, 0.3));
  const cv::Mat image(model.rig.size, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(StereoDepthStage(model, {}).process(1, image, image, 0.001).skew, 0.001);
  const RowTimes times(test::calibrationOf(model.rig), {kReadout, 0.25});
  model.right_times = times;
  EXPECT_NEAR(StereoDepthStage(model, {}).process(1, image, image, 0.001).skew, 0.001 + 0.75 * kReadout,
              1e-4);
  model.left_times = times;
  EXPECT_EQ(StereoDepthStage(model, {}).process(1, image, image, 0.001).skew, 0.001);
  // A camera that is rolled by a degree against the other, as in any rig, is read at the same time.
  CameraCalibration rolled = test::calibrationOf(model.rig);
  rolled.R = Eigen::AngleAxisd(0.0175, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  model.right_times = RowTimes(rolled, {kReadout, 0.25});
  EXPECT_NEAR(StereoDepthStage(model, {}).process(1, image, image, 0.001).skew, 0.001, 5e-5);
}

TEST(RollingShutter, ThatTakesLongerThanAPictureMakesNoPairValid) {
  const StereoRig rig = test::makeRig(320, 240, 0.3);
  Parameters parameters;
  parameters.rig.readout_time = 0.06;
  Pipeline pipeline =
      Pipeline::create(test::calibrationOf(rig), test::calibrationOf(rig, true), parameters).value();
  const cv::Mat image = test::GroundRenderer(12).left(rig, test::movingPose(0));
  for (int i = 0; i < 5; ++i) pipeline.process(i * kPeriod, image, image);
  const Pipeline::Output& output = pipeline.process(5 * kPeriod, image, image);
  for (const Failure& failure : {output.stereo.failure, output.approach.failure, output.landing.failure}) {
    EXPECT_EQ(failure.reason, Reason::kInputInvalid);
    EXPECT_EQ(failure.detail.substr(0, 25), "rig/readout_time: 0.06 s ");
  }
}

}  // namespace
}  // namespace uav_landing
