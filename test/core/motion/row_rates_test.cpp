#include "motion/step/row_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "motion/step/ego_motion.h"
#include "support/motion_matches.h"
#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::motionRig;
using test::Pose;

constexpr double kPeriod = 0.05, kReadout = 0.03, kNoise = 0.08;  // s, s, px
constexpr double kBias = 0.3 * kDegree;                           // rad/s

/// A camera that glides level, with its pitch and roll vibrating.
Pose vibratingPose(double t) {
  Pose pose;
  pose.position = {20 * t, 0, 27 - 1.9 * t};
  const double phase = 2 * M_PI * 37 * t;
  pose.pitch = (-5 + 0.05 * std::sin(phase)) * kDegree;
  pose.roll = 0.03 * std::sin(phase + 1) * kDegree;
  return pose;
}

/// What a gyroscope on it says of an image. late: error of its stamps, s.
AttitudePrior gyroAt(double stamp, double late, const Eigen::Vector3d& bias = Eigen::Vector3d::Zero()) {
  AttitudePrior prior;
  prior.rows = test::gyroRows(stamp + late, vibratingPose, bias);
  const test::Movement moved(vibratingPose(stamp - kPeriod), vibratingPose(stamp));
  const Eigen::AngleAxisd turn(moved.R);
  prior.rotation = turn.angle() * turn.axis() - kPeriod * bias;
  prior.rotation_covariance = 1e-6 * Eigen::Matrix3d::Identity();
  prior.duration = kPeriod;
  return prior;
}

Eigen::Vector2d seenBy(double stamp, const Eigen::Vector3d& world) {
  return test::rollingPixel(vibratingPose, motionRig(), stamp, kReadout, world);
}

/// The step up to a stamp, with matches as the rolling shutter makes them.
struct VibratingStep {
  double stamp;
  test::Step truth{vibratingPose(stamp - kPeriod), vibratingPose(stamp)};

  /// Estimate with the rows carried to the stamps by these rates.
  Expected<MotionEstimate> estimate(const RowRates& rates, ShakeMemory& memory) const {
    static const RowTimes times(test::calibrationOf(motionRig()), {kReadout, 0.5});
    const CameraMotion motion{truth.movement.R, truth.t};
    const StepEnds ends = rates.ends(motion, kPeriod, 1 + truth.n.dot(truth.t));
    const StampMap now(motionRig().K(), times, ends.now, truth.n),
        then(motionRig().K(), times, ends.then, motion.R.transpose() * truth.n);
    const Pose pose = vibratingPose(stamp);
    std::mt19937 random(static_cast<unsigned>(1000 * stamp));
    std::normal_distribution<double> noise(0, kNoise);
    std::uniform_real_distribution<double> u(10, motionRig().size.width - 10),
        v(215, motionRig().size.height - 10);
    std::vector<TemporalMatch> matches;
    while (matches.size() < 300) {
      const Eigen::Vector3d ray = motionRig().ray(u(random), v(random));
      if (truth.n.dot(ray) < 0.02) continue;
      const Eigen::Vector3d world =
          pose.worldFromOptical() * (pose.height() / truth.n.dot(ray) * ray) + pose.position;
      TemporalMatch match;
      match.now = now.toStamp(seenBy(stamp, world));
      match.then =
          then.toStamp(seenBy(stamp - kPeriod, world)) + Eigen::Vector2d(noise(random), noise(random));
      match.covariance = kNoise * kNoise * Eigen::Matrix2d::Identity();
      matches.push_back(match);
    }
    RowDoubt doubt = rates.doubt(kPeriod, kReadout);
    memory.begin();
    doubt.shake = {&times, &memory};
    MotionMemory work;
    return estimateMotion(motionRig(), matches,
                          {motion, {truth.n, test::across(truth.n, 1e-4)}, nullptr, doubt}, 20, work);
  }
};

struct Flown {
  double error = 0, ratio = 0;  ///< of the translation up and down in the last steps: mean square roots
  int shaken = 0;               ///< steps in which shake is found
};

/// late: error of the sensor's delay, s. heard: whether there is a sensor.
Flown fly(double late, bool heard = true, const Eigen::Vector3d& bias = Eigen::Vector3d::Zero()) {
  constexpr int kSteps = 60, kFirst = 30;
  RowRates rates(kBias);
  ShakeMemory memory;
  Flown flown;
  for (int i = 0; i <= kSteps; ++i) {
    const double stamp = 1 + i * kPeriod;
    rates.see(heard ? gyroAt(stamp, late, bias) : AttitudePrior());
    if (i == 0) {
      rates.skip();
      continue;
    }
    const VibratingStep step{stamp};
    const Expected<MotionEstimate> found = step.estimate(rates, memory);
    if (!found) {
      rates.skip();
      continue;
    }
    rates.add(found->motion, kPeriod, found->delay);
    if (i < kFirst) continue;
    const Eigen::Vector3d& n = step.truth.n;
    const double error = n.dot(found->motion.t - step.truth.t);
    flown.error += error * error / (kSteps - kFirst + 1);
    flown.ratio += error * error / n.dot(found->covariance.block<3, 3>(3, 3) * n) / (kSteps - kFirst + 1);
    flown.shaken += !found->of_shake.isZero(0);
  }
  return {std::sqrt(flown.error), std::sqrt(flown.ratio), flown.shaken};
}

TEST(RowRates, OfAGyroscopeTakeVibrationOut) {
  const Flown with = fly(0), without = fly(0, false);
  EXPECT_LT(with.error, 0.15 * without.error);
  EXPECT_LT(with.ratio, 1.5);
  EXPECT_EQ(with.shaken, 0);
  EXPECT_GT(without.shaken, 20) << "vibration must matter";
}

TEST(RowRates, LearnHowLateTheGyroscopeIs) {
  const Flown exact = fly(0);
  for (const double late : {-1e-3, 1e-3}) {
    const Flown learned = fly(late);
    EXPECT_LT(learned.error, 1.5 * exact.error) << late;
    EXPECT_LT(learned.ratio, 1.5) << late;
    EXPECT_EQ(learned.shaken, 0) << late;
  }
}

TEST(RowRates, LearnTheBiasOfTheGyroscope) {
  const Flown learned = fly(0, true, Eigen::Vector3d(0.5, -0.4, 0.3) * kDegree);
  EXPECT_LT(learned.error, 1.2 * fly(0).error);
  EXPECT_LT(learned.ratio, 1.5);
}

TEST(RowRates, AreThoseOfTheStepsWhereAnImageHasNoGyroscope) {
  RowRates rates(kBias);
  rates.see(gyroAt(1, 0));
  rates.skip();
  const CameraMotion step{rotationMatrix(Eigen::Vector3d(0.01, 0, 0)), Eigen::Vector3d(0, 0, 0.1)};
  rates.see(AttitudePrior());
  const StepEnds ends = rates.ends(step, kPeriod, 1);
  EXPECT_NEAR(ends.now.w.x(), 0.01 / kPeriod, 1e-9);
  EXPECT_NEAR(ends.then.w.x(), 0.01 / kPeriod, 1e-9) << "not the gyroscope at one end alone";
  EXPECT_FALSE(rates.measuredNow());
  EXPECT_EQ(rates.doubt(kPeriod, kReadout).delay.variance, 0);
  rates.see(gyroAt(1.05, 0));
  EXPECT_GT(rates.doubt(kPeriod, kReadout).delay.variance, 0);
  EXPECT_LT((*rates.measuredNow() - gyroAt(1.05, 0).rows->meanRate()).norm(), 1e-9);
  EXPECT_LT((rates.ends(step, kPeriod, 1).now.w - gyroAt(1.05, 0).rows->meanRate()).norm(), 1e-9);
}

}  // namespace
}  // namespace uav_landing
