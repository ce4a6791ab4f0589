#include "far/sighting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

/// Pairs from 2.2 km on, 60 m/s and 5 a second, with an attitude that is never the same.
class Approach {
 public:
  explicit Approach(const RunwayParameters& runway, const RunwayPicture& picture = {},
                    bool search_at_once = true)
      : picture_(picture), sighting_(modelOf(picture), parametersOf(search_at_once), runway) {}

  ApproachAngleResult::Sight next(const KnownGround& ground = {}, bool busy = false) {
    const double time = 0.2 * count_++;
    pose = {{-start + 60 * time, 8, 0.0545 * start - 3.1 * time},
            2 * kDegree * std::sin(1.5 * time),
            -3 * kDegree + 0.5 * kDegree * std::sin(2 * time),
            0.5 * kDegree};
    const cv::Mat left = picture_.render(pose, 100 + count_);
    cv::Mat right;
    if (stereo) {
      RunwayPose beside = pose;
      beside.position += pose.cameraFromRunway().transpose().col(0);  // a baseline of 1 m
      right = picture_.render(beside, 900 + count_);
      const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, right_shift, 0, 1, 0);
      cv::warpAffine(right, right, shift, right.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
    }
    return sighting_.process(10 + time, {left, right}, ground, busy);
  }

  double start = 2200;  // m before the threshold
  bool stereo = false;  // the right camera sees the runway, too
  int right_shift = 0;  // px by which its image is moved to the right
  RunwayPose pose;

 private:
  static RigModel modelOf(const RunwayPicture& picture) {
    RigModel model;
    model.rig = picture.rig();
    model.left_mask = model.right_mask = cv::Mat(picture.size, CV_8U, cv::Scalar(255));
    return model;
  }

  static ApproachAngleParameters parametersOf(bool search_at_once) {
    ApproachAngleParameters parameters;
    parameters.search_at_once = search_at_once;
    return parameters;
  }

  RunwayPicture picture_;
  Sighting sighting_;
  int count_ = 0;
};

RunwayParameters chart(double width, double length) {
  RunwayParameters runway;
  runway.width = width;
  runway.length = length;
  return runway;
}

TEST(Sighting, TellsThePositionAfterSomePairs) {
  Approach approach(chart(45, 2500));
  for (int i = 1; i < Sighting::kConfirmations; ++i)
    EXPECT_EQ(approach.next().failure.reason, Reason::kNotYet);
  for (int i = 0; i < 6; ++i) {
    const auto sight = approach.next();
    ASSERT_FALSE(sight.failure) << sight.failure.message();
    const Eigen::Vector3d error = sight.position - approach.pose.position;
    for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(error[k]), 3.5 * std::sqrt(sight.covariance(k, k))) << k;
    // From here a stripe of 0.9 m moves each edge by 3.5 m of 45, if it is there at all. The mean of both
    // readings is off by half of that at most, and by a little for the bars at the ends.
    EXPECT_LT(std::abs(error.x()), 0.09 * -approach.pose.position.x());
    EXPECT_LT(std::abs(error.z()), 0.09 * approach.pose.position.z());
    EXPECT_NEAR(sight.yaw, approach.pose.yaw, 0.2 * kDegree);
    EXPECT_TRUE(sight.height_without.allFinite());
  }
}

/// Some pairs from 950 m on, on level ground that stereo sees.
class NearApproach {
 public:
  /// right_shift: px by which the right camera's yaw moves its image; the ground knows of it.
  explicit NearApproach(int right_shift = 0) : approach_(chart(45, 2500), small()) {
    approach_.start = 950;
    approach_.stereo = true;
    approach_.right_shift = right_shift;
    for (int i = 0; i < 8; ++i)
      sight = approach_.next(groundAt(0.0545 * approach_.start - 0.62 * i, right_shift));
  }
  const RunwayPose& pose() const { return approach_.pose; }

  ApproachAngleResult::Sight sight;

  static RunwayPicture small() {
    RunwayPicture picture;
    picture.size = {320, 240};
    return picture;
  }

 private:
  static KnownGround groundAt(double height, int right_shift) {
    KnownGround ground;
    ground.plane.g = normalFromPitchRoll(-3 * kDegree, 0) / height;
    ground.plane.covariance = std::pow(0.2 / height, 2) * Eigen::Matrix3d::Identity();
    ground.right.turned.w = {0, -right_shift / small().focal, 0};
    ground.right.turned.covariance = std::pow(0.02 / small().focal, 2) * Eigen::Matrix3d::Identity();
    return ground;
  }

  Approach approach_;
};

TEST(Sighting, StereoSeesTheRunwayItselfWhenItIsNearEnough) {
  const NearApproach near;
  const ApproachAngleResult::Sight& sight = near.sight;
  const double focal = NearApproach::small().focal;
  ASSERT_FALSE(sight.failure) << sight.failure.message();
  // Between the depths of both ends.
  EXPECT_LT(sight.disparity, focal / -near.pose().position.x());
  EXPECT_GT(sight.disparity, focal / (2500 - near.pose().position.x()));
  EXPECT_GT(sight.disparity_variance, 0.02 * 0.02) << "the bias";
  EXPECT_GT(sight.height_by_bias, 0);
  EXPECT_LT(sight.height_by_chart, 0.9 * sight.position.z()) << "the chart no longer decides alone";
  const Eigen::Vector3d error = sight.position - near.pose().position;
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(error[k]), 3 * std::sqrt(sight.covariance(k, k))) << k;
  EXPECT_LT(std::abs(error.x()), 0.06 * -near.pose().position.x());
}

TEST(Sighting, ARightCameraThatIsKnownToHaveTurnedSeesTheSameDisparity) {
  const NearApproach straight, turned(1);
  ASSERT_FALSE(straight.sight.failure || turned.sight.failure);
  EXPECT_NEAR(turned.sight.disparity, straight.sight.disparity, 0.02);
  EXPECT_NEAR(turned.sight.position.x() / straight.sight.position.x(), 1, 0.02);
}

TEST(Sighting, ASearchIsSpreadOverPairs) {
  Approach approach(chart(45, 2500), {}, false);
  int pairs = 0;
  ApproachAngleResult::Sight sight;
  do {
    sight = approach.next();
    if (sight.failure) {
      EXPECT_EQ(sight.failure.reason, Reason::kNotYet) << sight.failure.message();
    }
  } while (sight.failure && ++pairs < 24);
  ASSERT_FALSE(sight.failure) << sight.failure.message();
  EXPECT_GE(pairs, Sighting::kConfirmations + 1) << "candidates take a pair, and every start another one";
  const Eigen::Vector3d error = sight.position - approach.pose.position;
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(error[k]), 3.5 * std::sqrt(sight.covariance(k, k))) << k;
}

TEST(Sighting, ASearchWaitsWhileAnotherOneTakesTheTime) {
  Approach approach(chart(45, 2500), {}, false);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(approach.next({}, true).failure.reason, Reason::kNoRunway);
  EXPECT_EQ(approach.next({}, false).failure.reason, Reason::kNotYet);
  for (int i = 0; i < 12; ++i)
    EXPECT_EQ(approach.next({}, true).failure.reason, Reason::kNotYet) << "it goes on later";
  int pairs = 0;
  while (approach.next().failure && pairs < 24) ++pairs;
  EXPECT_LT(pairs, 24);
}

TEST(Sighting, WithoutAChartNothingIsLookedFor) {
  Approach approach(chart(0, 0));
  for (int i = 0; i < 6; ++i) EXPECT_EQ(approach.next().failure.reason, Reason::kNoRunway);
}

TEST(Sighting, StereoFindsThatTheChartIsAnotherRunways) {
  Approach approach(chart(36, 2000));  // 20 % smaller in both: the same outline from nearer
  ApproachAngleResult::Sight sight;
  for (int i = 0; i < 6; ++i) {
    const RunwayPose& pose = approach.pose;
    approach.next();
    KnownGround ground;
    ground.plane.g = normalFromPitchRoll(pose.pitch, pose.roll) / pose.position.z();
    ground.plane.covariance = std::pow(1e-3 / pose.position.z(), 2) * Eigen::Matrix3d::Identity();
    sight = approach.next(ground);
  }
  ASSERT_FALSE(sight.failure) << sight.failure.message();
  EXPECT_NEAR(sight.size_over_chart, 1.25, 4 * std::sqrt(sight.size_over_chart_variance));
  EXPECT_LT(sight.position.z(), 0.97 * approach.pose.position.z()) << "the scale is the chart's";
}

TEST(Sighting, ARunwayThatLiesFarOffTheGroundsPlaneIsNoneAndSaysSo) {
  // By stereo the ground is 120 m below, and by this chart the runway is 60 m below: hills of 60 m would have
  // to lie within 1.1 km.
  Approach approach(chart(22, 1230));
  KnownGround ground;
  ApproachAngleResult::Sight sight;
  bool seen = false;
  for (int i = 0; i < 12; ++i) {
    sight = approach.next(ground);
    const RunwayPose& pose = approach.pose;
    ground.plane.g = normalFromPitchRoll(pose.pitch, pose.roll) / (pose.position.z() - 0.6);
    ground.plane.covariance = std::pow(1e-4 / pose.position.z(), 2) * Eigen::Matrix3d::Identity();
    seen |= sight.failure.message().find("by stereo the ground") != std::string::npos;
    EXPECT_TRUE(sight.failure) << "height " << sight.position.z();
  }
  EXPECT_TRUE(seen) << sight.failure.message();
}

TEST(Sighting, AnOutlineThatHardlyStandsOutIsNotFollowed) {
  RunwayPicture faint;
  faint.stripe = faint.bars = 0;
  faint.surface = faint.ground - 14;
  faint.noise = 5;
  Approach approach(chart(45, 2500), faint);
  bool said = false;
  for (int i = 0; i < 8; ++i) {
    const Failure failure = approach.next().failure;
    EXPECT_EQ(failure.reason, Reason::kNoRunway);
    said |= failure.detail.find("stands out") != std::string::npos;
  }
  EXPECT_TRUE(said);
}

TEST(Sighting, NothingOnBareGroundIsARunway) {
  RunwayPicture bare;
  bare.surface = bare.paint = bare.ground;
  Approach approach(chart(45, 2500), bare);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(approach.next().failure.reason, Reason::kNoRunway);
}

}  // namespace
}  // namespace uav_landing
