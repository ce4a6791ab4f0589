#include "motion/step/readout_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "motion/step/ego_motion.h"
#include "motion/step/turn_history.h"
#include "support/motion_matches.h"
#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

using test::motionRig;
using test::movingPose;
using test::Pose;

constexpr double kPeriod = 0.05, kReadout = 0.012;  // s

/// Where a camera with this readout time, the middle row at the stamp, sees a point of the ground.
Eigen::Vector2d seenBy(double stamp, double readout, const Eigen::Vector3d& world) {
  return test::rollingPixel(movingPose, motionRig(), stamp, readout, world);
}

/// Steady motion over one period, and the matches of it.
struct RollingStep {
  const Pose then = movingPose(0), now = movingPose(kPeriod);
  const test::Step truth{then, now};
  const CameraMotion motion{truth.movement.R, truth.t};
  const RowTimes unit{test::calibrationOf(motionRig()), {1.0, 0.5}};

  std::vector<TemporalMatch> matches(double readout) const {
    constexpr double kNoise = 0.05;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(20, motionRig().size.width - 20),
        v(200, motionRig().size.height - 20);
    std::vector<TemporalMatch> matches;
    while (matches.size() < 200) {
      const auto groundAt = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector3d {
        const Eigen::Vector3d ray = motionRig().ray(pixel.x(), pixel.y());
        return now.worldFromOptical() * (now.height() / truth.n.dot(ray) * ray) + now.position;
      };
      const Eigen::Vector2d at_stamp(u(random), v(random));
      const auto placeThen = [&](const Eigen::Vector2d& pixel) { return seenBy(0, 0, groundAt(pixel)); };
      TemporalMatch match;
      match.now = seenBy(kPeriod, readout, groundAt(at_stamp));
      match.then = seenBy(0, readout, groundAt(at_stamp));
      for (int axis = 0; axis < 2; ++axis)
        match.warp.col(axis) = placeThen(at_stamp + Eigen::Vector2d::Unit(axis)) - placeThen(at_stamp);
      match.covariance = kNoise * kNoise * Eigen::Matrix2d::Identity();
      matches.push_back(match);
    }
    return matches;
  }

  std::vector<TemporalMatch> shifted(double readout, double given) const {
    std::vector<TemporalMatch> all = matches(readout);
    shiftByReadout(motionRig(), overGround(ends()), given, all);
    return all;
  }
  StepEnds ends() const { return TurnHistory().ends(motion, kPeriod, 1 + truth.n.dot(truth.t)); }
  MotionOverGround overGround(const StepEnds& ends) const {
    return {motion, truth.n, {&unit, ends.now, ends.then}};
  }

  Expected<MotionEstimate> estimate(double readout, double given) const {
    return test::estimate(shifted(readout, given), truth.n, 1e-3, motion);
  }
};

TEST(ReadoutShift, CarriesMatchesToTheStamps) {
  const RollingStep step;
  const Expected<MotionEstimate> carried = step.estimate(kReadout, kReadout),
                                 left = step.estimate(kReadout, 0);
  ASSERT_TRUE(carried && left);
  EXPECT_LT((carried->motion.t - step.truth.t).norm(), 0.1 * (left->motion.t - step.truth.t).norm());
  EXPECT_GT((left->motion.t - step.truth.t).norm(), 1e-3) << "the shutter must matter";
}

TEST(ReadoutShift, CarriesMatchesToTheSamePlaceAgain) {
  const RollingStep step;
  std::vector<TemporalMatch> all = step.shifted(kReadout, kReadout);
  const std::vector<TemporalMatch> once = all;
  shiftByReadout(motionRig(), step.overGround(step.ends()), kReadout, all);
  for (size_t i = 0; i < all.size(); ++i) EXPECT_LT((all[i].then - once[i].then).norm(), 1e-6) << i;
}

TEST(ReadoutShift, HasTheTurnThatGetsFaster) {
  const RollingStep step;
  StepEnds ends = step.ends();
  ends.now.a = {3, -2, 9};
  const RowTimes rows(test::calibrationOf(motionRig()), {kReadout, 0.5});
  const StampMap now(motionRig().K(), rows, ends.now, step.truth.n),
      then(motionRig().K(), rows, ends.then, step.motion.R.transpose() * step.truth.n);
  const std::vector<TemporalMatch> seen = step.matches(kReadout), even = step.shifted(kReadout, kReadout);
  std::vector<TemporalMatch> carried = seen;
  shiftByReadout(motionRig(), step.overGround(ends), kReadout, carried);
  double farthest = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d wanted =
        then.toStamp(seen[i].then) - seen[i].then - seen[i].warp * (now.toStamp(seen[i].now) - seen[i].now);
    EXPECT_LT((carried[i].then - seen[i].then - wanted).norm(), 0.005) << i;
    farthest = std::max(farthest, (carried[i].then - even[i].then).norm());
  }
  EXPECT_GT(farthest, 0.02) << "the acceleration must matter";
}

TEST(ReadoutShift, TellsWhatTheTimeDoesToTheMotion) {
  const RollingStep step;
  for (const double readout : {kReadout, -kReadout}) {
    const Expected<MotionEstimate> found = step.estimate(readout, 0);
    ASSERT_TRUE(found);
    const Eigen::Vector3d t = found->motion.t + readout * found->readout.by_time.segment<3>(3);
    const Eigen::Vector3d n = found->normal + readout * found->readout.by_time.tail<3>();
    EXPECT_LT((t - step.truth.t).norm(), 0.1 * (found->motion.t - step.truth.t).norm());
    EXPECT_LT((n - step.truth.n).norm(), 0.2 * (found->normal - step.truth.n).norm() + 1e-5);
  }
}

TEST(ReadoutShift, FindsTheTimeInTheMatches) {
  const RollingStep step;
  for (const double readout : {0.0, kReadout, -kReadout, 0.5 * kReadout}) {
    const Expected<MotionEstimate> found = step.estimate(readout, 0);
    ASSERT_TRUE(found);
    ASSERT_GT(found->readout.information, 0);
    EXPECT_NEAR(found->readout.score / found->readout.information, readout, 0.05 * kReadout);
    const Expected<MotionEstimate> known = step.estimate(readout, readout);
    ASSERT_TRUE(known);
    EXPECT_NEAR(known->readout.score / known->readout.information, 0, 0.05 * kReadout);
  }
}

TEST(ReadoutShift, IsNotTakenForRowsThatShake) {
  const RollingStep step;
  const std::vector<TemporalMatch> all = step.shifted(kReadout, 0);
  ShakeMemory memory;
  MotionMemory work;
  for (int i = 0; i < 60; ++i) {
    const Expected<MotionEstimate> found = estimateMotion(motionRig(), all,
                                                          {step.motion,
                                                           {step.truth.n, test::across(step.truth.n, 1e-3)},
                                                           nullptr,
                                                           {{&step.unit, &memory}, Eigen::Vector3d::Zero()}},
                                                          20, work);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->of_shake.isZero(0)) << i;
  }
}

TEST(ReadoutShift, LeavesMatchesWithoutDoubtAsTheyAre) {
  const RollingStep step;
  std::vector<TemporalMatch> matches = step.matches(kReadout);
  const Eigen::Vector2d before = matches.front().then;
  shiftByReadout(motionRig(), {step.motion, step.truth.n}, 1, matches);
  EXPECT_EQ(matches.front().then, before);
  EXPECT_TRUE(matches.front().by_readout.isZero(0));
  const Expected<MotionEstimate> found = test::estimate(matches, step.truth.n, 1e-3, step.motion);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->readout.information, 0);
}

}  // namespace
}  // namespace uav_landing
