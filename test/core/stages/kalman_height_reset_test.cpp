// A reset, or a jump of the clock, forgets everything: the stage is then as if it were new. Whatever state
// outlives its flight shows here.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "support/degree.h"
#include "support/ground_matches.h"
#include "support/rigs.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kT = 0.05;

/// A flight with markings, a runway, an imu, and a rig that is measured. What is random is drawn from
/// `random`.
struct Flight {
  double speed = 20, sink = 1.5, height = 15, pitch = -4 * kDegree, roll = 1 * kDegree;
  double rig_pitch = 0;   // rad, that vertical disparities show
  double way_factor = 1;  // of the motion that the images show
  double surface = 0;     // variance of the surface about its plane, m^2
  double aside = 0.02;    // tangent of the runway's direction against the camera's
  double tilt = 0;        // of the motion's own normal against the plane's, rad
  double noise = 1e-3;    // of the height, over it
  bool spoiled = false;   // repeats pictures, loses planes, tilts and contradicts itself now and then
  std::mt19937 random{1};

  void pair(double stamp, int number, StereoDepthResult& stereo, ApproachAngleResult& approach) {
    std::normal_distribution<double> normal;
    const double now = height - sink * kT * number;
    const bool odd = spoiled && number % 7 == 3, wild = spoiled && number % 11 == 5;
    const Eigen::Vector3d down = normalFromPitchRoll(pitch + (odd ? 1.5 * kDegree : 0), roll);
    stereo = {};
    stereo.stamp = stamp;
    stereo.plane.g = down / (now * (1 + noise * normal(random)) * (wild ? 1.2 : 1));
    const double along = 0.02 / (now * now);
    stereo.plane.covariance = along * along * Eigen::Matrix3d::Identity();
    stereo.below = stereo.plane;
    stereo.below.g.y() *= 1.002;
    stereo.below.covariance *= 1.5;
    stereo.points = test::matchesOn(test::usualRig(), stereo.plane.g);
    stereo.surface_variance = surface;
    stereo.disparity_bias_stddev = 0.02;
    stereo.row_bias_stddev = 0.03;
    stereo.row_agreement = wild ? 0.2 : 0.9;
    stereo.vertical_rotation.w = Eigen::Vector3d(rig_pitch + 1e-5 * normal(random), 0, 1e-5 * normal(random));
    stereo.vertical_rotation.covariance = 1e-9 * Eigen::Matrix3d::Identity();
    stereo.vertical_rotation.count = 200;
    if (spoiled && number % 13 == 8) stereo.left_repeated = true;
    if (spoiled && number % 17 == 9) stereo.failure = {Reason::kTooFewMatches, "7 of at least 20"};

    approach = {};
    approach.stamp = stamp;
    approach.n = normalFromPitchRoll(pitch, roll);
    approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d p =
        Eigen::Vector3d(aside, 0, 1) - Eigen::Vector3d(aside, 0, 1).dot(approach.n) * approach.n;
    approach.vanishing_direction = p.normalized();
    approach.vanishing_covariance =
        1e-6 * (Eigen::Matrix3d::Identity() -
                approach.vanishing_direction * approach.vanishing_direction.transpose());
    approach.other_runway_probability = 1e-4;
    if (wild) approach.vanishing_direction = (p + 0.05 * approach.n).normalized();
    for (ApproachAngleResult::Motion* motion : {&approach.step, &approach.window}) {
      motion->duration = motion == &approach.step ? kT : 0.4;
      motion->rotation = spoiled ? Eigen::Vector3d(0, 0.002, 0) : Eigen::Vector3d::Zero().eval();
      const Eigen::Vector3d forward = approach.vanishing_direction;
      motion->translation_over_height =
          way_factor * (odd ? 3 : 1) * motion->duration * (speed * forward + sink * approach.n) / now;
      motion->covariance = 1e-8 * Matrix6d::Identity();
      motion->angle = std::atan(sink / speed);
      motion->angle_variance = 1e-6;
      motion->normal = normalFromPitchRoll(pitch + tilt, roll);
      motion->normal_covariance = 1e-7 * (Eigen::Matrix3d::Identity() - approach.n * approach.n.transpose());
    }
    approach.runway.failure = {};
    approach.runway.y = 0.1;
    approach.runway.y_variance = 1e-4;
    approach.runway.width = 30 / now;
    approach.runway.width_variance = 1e-6;
    approach.runway.x = -5;
    approach.runway.x_variance = 1e-3;
    approach.foe = {320, 240};
  }
};

void expectSame(double a, double b, const std::string& what) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << what << ": " << a << " instead of " << b;
}

void expectSame(const LandingResult& a, const LandingResult& b) {
  EXPECT_EQ(a.failure.message(), b.failure.message());
  EXPECT_EQ(a.height_valid, b.height_valid);
  EXPECT_EQ(a.angle_valid, b.angle_valid);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.consecutive_rejections, b.consecutive_rejections);
  EXPECT_EQ(a.protection_source, b.protection_source);
  expectSame(a.height, b.height, "height");
  expectSame(a.height_variance, b.height_variance, "height's variance");
  expectSame(a.raw_height_variance, b.raw_height_variance, "raw height's variance");
  expectSame(a.vertical_speed, b.vertical_speed, "vertical speed");
  expectSame(a.vertical_speed_variance, b.vertical_speed_variance, "vertical speed's variance");
  expectSame(a.approach_angle_variance, b.approach_angle_variance, "angle's variance");
  expectSame(a.raw_approach_angle_variance, b.raw_approach_angle_variance, "raw angle's variance");
  expectSame(a.pitch, b.pitch, "pitch");
  expectSame(a.pitch_variance, b.pitch_variance, "pitch's variance");
  expectSame(a.yaw, b.yaw, "yaw");
  expectSame(a.yaw_variance, b.yaw_variance, "yaw's variance");
  expectSame(a.x, b.x, "x");
  expectSame(a.x_variance, b.x_variance, "x's variance");
  expectSame(a.y, b.y, "y");
  expectSame(a.y_variance, b.y_variance, "y's variance");
  expectSame(a.width_height, b.width_height, "height by the width");
  expectSame(a.velocity.norm(), b.velocity.norm(), "velocity");
  expectSame(a.twist_covariance.norm(), b.twist_covariance.norm(), "covariance of the twist");
  expectSame(a.rig_rotation.w.norm(), b.rig_rotation.w.norm(), "rig's rotation");
  expectSame(a.height_protection_level, b.height_protection_level, "protection level");
  ASSERT_EQ(a.tests.size(), b.tests.size());
  for (size_t i = 0; i < a.tests.size(); ++i) {
    expectSame(a.tests[i].ratio, b.tests[i].ratio, a.tests[i].name);
    EXPECT_EQ(a.tests[i].consecutive_failures, b.tests[i].consecutive_failures) << a.tests[i].name;
  }
}

/// Another aircraft's flight, of a random time, so that it ends in one of many states. Returns the stamp of
/// the next pair.
double flyBefore(int seed, KalmanHeightStage& stage) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const int pairs = std::uniform_int_distribution<int>(4, 90)(random);
  Flight flight;
  flight.random = random;
  flight.spoiled = seed % 3 != 0;
  if (!flight.spoiled) {
    flight.aside = 0.3;
    flight.tilt = 0.02;
    flight.noise = 2e-3;
  }
  flight.speed = 35;
  flight.height = 25;
  flight.pitch = -7 * kDegree;
  flight.rig_pitch = 4e-4;
  flight.surface = 0.01;
  StereoDepthResult stereo;
  ApproachAngleResult approach;
  double stamp = 500;
  for (int i = 0; i < pairs; ++i, stamp += kT) {
    flight.pair(stamp, i, stereo, approach);
    stage.process(stereo, approach);
  }
  // The last pairs stand still or are a picture once more.
  for (int i = 0; i < seed % 4; ++i, stamp += kT) {
    flight.way_factor = 1e-3;
    flight.pair(stamp, pairs + i, stereo, approach);
    stereo.left_repeated = seed % 2 == 0;
    stage.process(stereo, approach);
  }
  return stamp;
}

class AfterAJump : public testing::TestWithParam<int> {};

TEST_P(AfterAJump, AFlightIsEstimatedAsIfNothingHadBeenBefore) {
  KalmanHeightStage used(test::usualRig(), {}), fresh(test::usualRig(), {});
  flyBefore(GetParam(), used);
  StereoDepthResult stereo;
  ApproachAngleResult approach;
  Flight of_used, of_fresh;
  of_used.random.seed(9);
  of_fresh.random.seed(9);
  for (int i = 0; i < 60; ++i) {
    of_used.pair(100 + kT * i, i, stereo, approach);
    LandingResult result = used.process(stereo, approach);
    of_fresh.pair(100 + kT * i, i, stereo, approach);
    const LandingResult expected = fresh.process(stereo, approach);
    if (i == 0) {
      EXPECT_EQ(result.failure.reason, Reason::kTimeJump);
      EXPECT_FALSE(result.angle_valid);
      result.failure = expected.failure;
      result.angle_valid = expected.angle_valid;
    }
    expectSame(result, expected);
    if (HasFailure()) return;  // the pairs behind it say no more
  }
}

INSTANTIATE_TEST_SUITE_P(InManyStates, AfterAJump, testing::Range(0, 24));

class AfterAReset : public testing::TestWithParam<int> {};

/// Its stamps go on, so that nothing is forgotten for its age. It begins with a pair that contradicts itself.
TEST_P(AfterAReset, AFlightIsEstimatedAsIfNothingHadBeenBefore) {
  constexpr int kWildPair = 5;
  KalmanHeightStage used(test::usualRig(), {}), fresh(test::usualRig(), {});
  const double begin = flyBefore(GetParam(), used);
  used.reset();
  Flight flight;
  flight.spoiled = true;
  StereoDepthResult stereo;
  ApproachAngleResult approach;
  for (int i = 0; i < 30; ++i) {
    flight.pair(begin + kT * i, kWildPair + i, stereo, approach);
    expectSame(used.process(stereo, approach), fresh.process(stereo, approach));
    if (HasFailure()) return;  // the pairs behind it say no more
  }
}

INSTANTIATE_TEST_SUITE_P(InManyStates, AfterAReset, testing::Range(0, 24));

}  // namespace
}  // namespace uav_landing
