#include "uav_landing/motion/imu_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::Pose;

/// Forward, left, up of the camera.
Eigen::Matrix3d opticalFromBody() {
  Eigen::Matrix3d rotation;
  rotation << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return rotation;
}

/// A sensor mounted askew that turns about all its axes at once.
class ImuBufferTest : public ::testing::Test {
 protected:
  static Pose poseAt(double t) {
    Pose pose;
    pose.pitch = (-4 + 6 * std::sin(t)) * kDegree;
    pose.roll = 20 * std::sin(2 * t) * kDegree;
    pose.yaw = (100 + 15 * t) * kDegree;
    return pose;
  }
  static Eigen::Quaterniond orientationAt(double t) {
    return Eigen::Quaterniond(poseAt(t).worldFromOptical() * opticalFromImu());
  }
  /// The camera sees the sensor's axes turned by this.
  static Eigen::Matrix3d opticalFromImu() {
    return opticalFromBody() *
           Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  }
  static ImuSample sampleAt(double t, double delay = 0) {
    constexpr double kStep = 1e-5;
    ImuSample sample;
    sample.stamp = t + delay;
    sample.orientation = orientationAt(t);
    const Eigen::AngleAxisd turn(orientationAt(t - kStep).conjugate() * orientationAt(t + kStep));
    sample.angular_velocity = turn.angle() / (2 * kStep) * turn.axis();
    return sample;
  }
  ImuBuffer filled(double rate, double until, double delay = 0) const {
    ImuBuffer buffer(parameters);
    for (int i = 0; i <= until * rate; ++i) buffer.add(sampleAt(i / rate, delay));
    return buffer;
  }
  static void expectNormal(const AttitudePrior& prior, double t, double tolerance) {
    ASSERT_TRUE(prior.hasNormal()) << prior.failure.message();
    EXPECT_LT((prior.normal - poseAt(t).down()).norm(), tolerance);
  }
  static void expectRotation(const AttitudePrior& prior, double then, double now, double tolerance) {
    ASSERT_TRUE(prior.hasRotation());
    EXPECT_NEAR(prior.duration, now - then, 1e-9);
    // x_now = R x_then for what is at rest.
    const Eigen::AngleAxisd truth(poseAt(now).worldFromOptical().transpose() *
                                  poseAt(then).worldFromOptical());
    EXPECT_LT((prior.rotation - truth.angle() * truth.axis()).norm(), tolerance);
  }

  ApproachAngleParameters parameters;
  const Eigen::Matrix3d mounting_ = opticalFromImu();
};

/// A sensor on a rig that vibrates, and rows of 30 ms around the stamp.
class ImuRowsTest : public ImuBufferTest {
 protected:
  static constexpr RowSpan kRows{-0.015, 0.015};  // s
  static constexpr double kStamp = 0.5, kAmplitude = 0.01, kFrequency = 37;

  /// Turn of the sensor about its y axis, rad.
  static double angleAt(double t) { return kAmplitude * std::sin(2 * M_PI * kFrequency * t); }
  static ImuSample sampleOf(double t) {
    ImuSample sample;
    sample.stamp = t;
    const double rate = 2 * M_PI * kFrequency * kAmplitude * std::cos(2 * M_PI * kFrequency * t);
    sample.angular_velocity = Eigen::Vector3d(0, rate, 0);
    return sample;
  }
  ImuBuffer vibrating(double rate, double until) const {
    ImuBuffer buffer(parameters, kRows);
    for (int i = 0; i <= until * rate; ++i) buffer.add(sampleOf(i / rate));
    return buffer;
  }
  AttitudePrior at(const ImuBuffer& buffer) const { return buffer.at(kStamp, std::nullopt, mounting_); }
};

TEST_F(ImuRowsTest, TurnsBetweenRowsAreThoseOfTheVibration) {
  for (const double rate : {200.0, 400.0, 1000.0}) {
    const AttitudePrior prior = at(vibrating(rate, 0.6));
    ASSERT_TRUE(prior.rows) << rate << ' ' << prior.rows_failure.message();
    for (const double t : {-0.015, -0.0062, 0.0, 0.004, 0.015}) {
      const Eigen::Vector3d turn = prior.rows->beyondMean(t) + t * prior.rows->meanRate();
      // The scene turns the other way than the sensor.
      const Eigen::Vector3d truth = mounting_ * Eigen::Vector3d(0, angleAt(kStamp) - angleAt(kStamp + t), 0);
      EXPECT_LT((turn - truth).norm(), 0.03 * kAmplitude) << rate << ' ' << t;
    }
  }
}

TEST_F(ImuRowsTest, NeedMessagesAtTwoHundredHertz) {
  const AttitudePrior prior = at(vibrating(100, 0.6));
  EXPECT_FALSE(prior.rows);
  EXPECT_EQ(prior.rows_failure.detail,
            "the imu's messages are up to 10 ms apart while rows are exposed: 200 Hz are needed");
  ImuBuffer with_gap(parameters, kRows);
  for (int i = 0; i <= 240; ++i)
    if (i != 198) with_gap.add(sampleOf(i / 400.0));
  EXPECT_TRUE(at(with_gap).rows);
  ImuBuffer with_longer_gap(parameters, kRows);
  for (int i = 0; i <= 240; ++i)
    if (i != 198 && i != 199) with_longer_gap.add(sampleOf(i / 400.0));
  EXPECT_FALSE(at(with_longer_gap).rows);
  EXPECT_FALSE(at(with_longer_gap).rows_failure.detail.empty());
}

TEST_F(ImuRowsTest, NeedTheMessageAfterTheLastRow) {
  const AttitudePrior late = at(vibrating(400, 0.51));
  EXPECT_FALSE(late.rows);
  EXPECT_EQ(late.rows_failure.detail,
            "the newest imu message is 5 ms before the last row: it comes too late");
  EXPECT_TRUE(at(vibrating(400, 0.515)).rows);
  EXPECT_FALSE(vibrating(400, 0.51).covers(kStamp)) << "a pair waits for it";
  EXPECT_TRUE(vibrating(400, 0.515).covers(kStamp));
  EXPECT_TRUE(vibrating(100, 0.51).covers(kStamp))
      << "these messages tell no rows, so there is none to wait for";
}

TEST_F(ImuRowsTest, AreNotLookedAtWithAGlobalShutter) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 240; ++i) buffer.add(sampleOf(i / 400.0));
  EXPECT_FALSE(at(buffer).rows);
  EXPECT_FALSE(at(buffer).rows_failure);
  EXPECT_TRUE(buffer.covers(0.6));
}

TEST_F(ImuRowsTest, NeedAnAngularVelocity) {
  ImuBuffer buffer(parameters, kRows);
  for (int i = 0; i <= 240; ++i) {
    ImuSample sample = sampleAt(i / 400.0);
    sample.angular_velocity.reset();
    buffer.add(sample);
  }
  EXPECT_FALSE(at(buffer).rows);
  EXPECT_TRUE(at(buffer).rows_failure);
}

TEST_F(ImuBufferTest, GravityAndRotationBetweenMessagesAreThoseOfThePose) {
  const ImuBuffer buffer = filled(100, 2);
  for (const double t : {0.503, 1.0, 1.2345}) {
    const AttitudePrior prior = buffer.at(t, t - 0.05, mounting_);
    expectNormal(prior, t, 1e-4);
    expectRotation(prior, t - 0.05, t, 1e-4);
    EXPECT_EQ(prior.failure.message(), "");
  }
}

TEST_F(ImuBufferTest, ADelayShiftsTheStamps) {
  parameters.imu_delay = 0.03;
  const AttitudePrior prior = filled(100, 2, 0.03).at(1.0, 0.9, mounting_);
  expectNormal(prior, 1.0, 1e-4);
  expectRotation(prior, 0.9, 1.0, 1e-4);
  // The newest message bears the stamp 2.03 and is of 2.0.
  EXPECT_TRUE(filled(100, 2, 0.03).covers(2.0));
  EXPECT_FALSE(filled(100, 2, 0.03).covers(2.02));
  parameters.imu_delay = 0;
  const AttitudePrior late = filled(100, 2, 0.03).at(1.0, 0.9, mounting_);
  EXPECT_GT((late.normal - poseAt(1.0).down()).norm(), 3e-3) << "20 deg/s and more for 0.03 s";
}

TEST_F(ImuBufferTest, MessagesThatComeOutOfOrderOrTwiceChangeNothing) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 200; ++i) {
    const int swapped = i % 4 == 1 ? i + 1 : i % 4 == 2 ? i - 1 : i;
    buffer.add(sampleAt(0.01 * swapped));
    ImuSample again = sampleAt(0.01 * swapped);
    again.orientation = Eigen::Quaterniond::Identity();
    buffer.add(again);
  }
  const AttitudePrior mixed = buffer.at(1.234, 1.1, mounting_);
  const AttitudePrior sorted = filled(100, 2).at(1.234, 1.1, mounting_);
  EXPECT_LT((mixed.normal - sorted.normal).norm(), 1e-12);
  EXPECT_LT((mixed.rotation - sorted.rotation).norm(), 1e-12);
}

TEST_F(ImuBufferTest, AClockThatIsSetBackStartsAnew) {
  ImuBuffer buffer = filled(100, 20);
  for (int i = 0; i <= 50; ++i) buffer.add(sampleAt(0.01 * i));
  expectNormal(buffer.at(0.4, 0.3, mounting_), 0.4, 1e-4);
  EXPECT_FALSE(buffer.covers(10));
}

// Between a message that claims a covariance and one that does not, nothing is known but the parameter.
TEST_F(ImuBufferTest, BetweenMessagesOfWhichOneClaimsNothingTheParameterClaims) {
  for (const bool first_claims : {true, false}) {
    ImuBuffer buffer(parameters);
    for (int i = 0; i < 2; ++i) {
      ImuSample sample = sampleAt(0.01 * i);
      if ((i == 0) == first_claims) sample.orientation_covariance = 0.01 * Eigen::Matrix3d::Identity();
      buffer.add(sample);
    }
    const AttitudePrior prior = buffer.at(0.005, std::nullopt, mounting_);
    ASSERT_TRUE(prior.hasNormal()) << prior.failure.message();
    const double variance = std::pow(parameters.imu_attitude_stddev_deg * kDegree, 2);
    EXPECT_NEAR(prior.normal_covariance.trace(), 2 * variance, 1e-3 * variance) << first_claims;
  }
}

TEST_F(ImuBufferTest, AheadOfTheNewestMessageItTurnsOnAndSaysSoByItsVariance) {
  const ImuBuffer buffer = filled(100, 1);
  EXPECT_TRUE(buffer.covers(1.0));
  EXPECT_FALSE(buffer.covers(1.04));
  const AttitudePrior ahead = buffer.at(1.04, 0.95, mounting_);
  expectNormal(ahead, 1.04, 2e-3);
  expectRotation(ahead, 0.95, 1.04, 3e-3);
  EXPECT_GT(ahead.normal_covariance.trace(), buffer.at(1.0, 0.95, mounting_).normal_covariance.trace());
  const AttitudePrior beyond = buffer.at(1.3, 1.25, mounting_);
  EXPECT_FALSE(beyond.hasNormal());
  EXPECT_FALSE(beyond.hasRotation());
  EXPECT_EQ(beyond.failure.message(), "timeout: the newest imu message is 0.3 s before the image");
}

TEST_F(ImuBufferTest, AGapIsNotBridged) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 200; ++i)
    if (i < 90 || i > 110) buffer.add(sampleAt(0.01 * i));
  EXPECT_EQ(buffer.at(1.0, 0.5, mounting_).failure.message(),
            "timeout: no imu message within 0.1 s around the image");
  const AttitudePrior after = buffer.at(1.2, 0.85, mounting_);
  expectNormal(after, 1.2, 1e-4);
  // The angular velocity is not known all the way, but the attitudes at both ends are.
  expectRotation(after, 0.85, 1.2, 1e-4);
}

TEST_F(ImuBufferTest, AGyroAloneGivesTheRotationAndSaysThatThereIsNoOrientation) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 200; ++i) {
    ImuSample sample = sampleAt(0.01 * i);
    sample.orientation.reset();
    buffer.add(sample);
  }
  const AttitudePrior prior = buffer.at(1.004, 0.9, mounting_);
  EXPECT_FALSE(prior.hasNormal());
  EXPECT_EQ(prior.failure.message(), "input_invalid: the imu messages have no orientation");
  expectRotation(prior, 0.9, 1.004, 1e-4);
}

TEST_F(ImuBufferTest, WithoutAGyroTheAttitudesGiveTheRotation) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 200; ++i) {
    ImuSample sample = sampleAt(0.01 * i);
    sample.angular_velocity.reset();
    buffer.add(sample);
  }
  expectRotation(buffer.at(1.004, 0.9, mounting_), 0.9, 1.004, 1e-4);
}

TEST_F(ImuBufferTest, VariancesAreThoseOfTheMessageOrTheDefault) {
  parameters.imu_attitude_stddev_deg = 2;
  parameters.imu_rate_stddev_deg = 0.4;
  parameters.imu_rate_bias_deg = 0.3;
  const AttitudePrior unknown = filled(100, 2).at(1.0, 0.9, mounting_);
  EXPECT_NEAR(pitchVariance(unknown.normal, unknown.normal_covariance), std::pow(2 * kDegree, 2), 1e-9);
  EXPECT_NEAR(rollVariance(unknown.normal, unknown.normal_covariance), std::pow(2 * kDegree, 2), 1e-4);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(unknown.rotation_covariance(i, i)), 0.1 * 0.5 * kDegree, 1e-6);
  EXPECT_NEAR(unknown.normal.dot(unknown.normal_covariance * unknown.normal), 0, 1e-12);

  // Of a sensor that knows its roll well and its pitch badly; its axes are the body's.
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 200; ++i) {
    ImuSample sample = sampleAt(0.01 * i);
    sample.orientation = Eigen::Quaterniond(Pose().worldFromOptical() * opticalFromBody());
    sample.orientation_covariance = Eigen::Vector3d(1e-6, 4e-4, 1).asDiagonal();
    sample.angular_velocity_covariance = 1e-4 * Eigen::Matrix3d::Identity();
    buffer.add(sample);
  }
  const AttitudePrior known = buffer.at(1.0, 0.9, opticalFromBody());
  EXPECT_NEAR(std::sqrt(rollVariance(known.normal, known.normal_covariance)), 1e-3, 1e-5);
  EXPECT_NEAR(std::sqrt(pitchVariance(known.normal, known.normal_covariance)), 2e-2, 1e-4);
  EXPECT_NEAR(known.rotation_covariance(0, 0), 0.01 * (1e-4 + std::pow(0.3 * kDegree, 2)), 1e-9);
}

/// Covariance of a vector over many draws, by a normal number for each axis.
template <class Draw>
Eigen::Matrix3d spreadOf(const Eigen::Vector3d& mean, const Draw& draw) {
  constexpr int kSamples = 20000;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d axes(normal(random), normal(random), normal(random));
    const Eigen::Vector3d error = draw(axes) - mean;
    spread += error * error.transpose() / kSamples;
  }
  return spread;
}

Eigen::Quaterniond smallTurn(const Eigen::Vector3d& w) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(w.norm(), w.normalized()));
}

// A sensor mounted askew that knows each of its axes differently well.
TEST_F(ImuBufferTest, CovariancesAreThoseOfSamples) {
  const Eigen::Vector3d attitude(2e-3, 8e-3, 4e-3), rate(3e-3, 1e-3, 9e-3);
  parameters.imu_rate_bias_deg = 0;
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 100; ++i) {
    ImuSample sample = sampleAt(0.01 * i);
    sample.orientation_covariance = attitude.cwiseAbs2().asDiagonal();
    sample.angular_velocity_covariance = rate.cwiseAbs2().asDiagonal();
    buffer.add(sample);
  }
  const auto normalOf = [&](const Eigen::Quaterniond& orientation) -> Eigen::Vector3d {
    return mounting_ * (orientation.conjugate() * Eigen::Vector3d(0, 0, -1));
  };
  const AttitudePrior prior = buffer.at(0.8, 0.7, mounting_);
  const Eigen::Matrix3d normals = spreadOf(normalOf(orientationAt(0.8)), [&](const Eigen::Vector3d& axes) {
    return normalOf(orientationAt(0.8) * smallTurn(attitude.cwiseProduct(axes)));
  });
  EXPECT_LT((prior.normal_covariance - normals).norm(), 0.05 * normals.norm());
  // An error of the rate that stays the same turns by 0.1 s of it.
  const Eigen::Matrix3d turns = spreadOf(Eigen::Vector3d::Zero(), [&](const Eigen::Vector3d& axes) {
    return Eigen::Vector3d(mounting_ * (0.1 * rate.cwiseProduct(axes)));
  });
  EXPECT_LT((prior.rotation_covariance - turns).norm(), 0.05 * turns.norm());
  // Ahead of the newest message it turns on by a rate that is wrong.
  const AttitudePrior ahead = buffer.at(1.08, 1.0, mounting_);
  const Eigen::Matrix3d extrapolated = [&] {
    const Eigen::Vector3d stddev = (attitude.cwiseAbs2() + 0.08 * 0.08 * rate.cwiseAbs2()).cwiseSqrt();
    return spreadOf(ahead.normal, [&](const Eigen::Vector3d& axes) -> Eigen::Vector3d {
      const Eigen::Vector3d w = mounting_ * stddev.cwiseProduct(axes);
      return smallTurn(w).conjugate() * ahead.normal;
    });
  }();
  EXPECT_LT((ahead.normal_covariance - extrapolated).norm(), 0.05 * extrapolated.norm());
}

TEST_F(ImuBufferTest, BetweenMessagesOfDifferentCertaintyIsInBetween) {
  ImuBuffer buffer(parameters);
  parameters.imu_rate_bias_deg = 0;
  for (int i = 0; i < 2; ++i) {
    ImuSample sample = sampleAt(0.04 * i);
    sample.orientation_covariance = (1e-4 + 4e-4 * i) * Eigen::Matrix3d::Identity();
    sample.angular_velocity_covariance = (1e-4 + 4e-4 * i) * Eigen::Matrix3d::Identity();
    buffer.add(sample);
  }
  // A quarter of the way: across the normal there are two directions.
  const AttitudePrior prior = buffer.at(0.01, 0.0, mounting_);
  EXPECT_NEAR(prior.normal_covariance.trace(), 2 * 2e-4, 1e-9);
  EXPECT_LT((prior.normal - poseAt(0.01).down()).norm(), 1e-3);
  EXPECT_NEAR(prior.rotation_covariance(0, 0), 1e-4 * (2e-4 + std::pow(0.1 * kDegree, 2)), 1e-12);
}

TEST_F(ImuBufferTest, BetweenMessagesTheRateChangesEvenly) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i < 2; ++i) {
    ImuSample sample;
    sample.stamp = 0.08 * i;
    sample.angular_velocity = Eigen::Vector3d(0, i, 0);
    buffer.add(sample);
  }
  // From 0 to 1 rad/s in 0.08 s: it has turned by t^2 / 0.16.
  for (const double t : {0.02, 0.04, 0.06})
    EXPECT_NEAR(buffer.at(t, 0.0, mounting_).rotation.norm(), t * t / 0.16, 1e-9) << t;
}

TEST_F(ImuBufferTest, SaysNothingOfTheTimeBeforeTheFirstMessageHoweverNear) {
  ImuBuffer buffer(parameters);
  for (int i = 0; i <= 50; ++i) buffer.add(sampleAt(1 + 0.01 * i));
  const AttitudePrior prior = buffer.at(0.98, 0.9, mounting_);
  EXPECT_FALSE(prior.hasNormal());
  EXPECT_FALSE(prior.hasRotation());
  EXPECT_EQ(prior.failure.message(), "not_yet: the oldest imu message is 0.02 s after the image");
  EXPECT_FALSE(buffer.at(1.2, 0.98, mounting_).hasRotation()) << "from before the first message";
}

TEST_F(ImuBufferTest, HasNothingOnceItIsCleared) {
  ImuBuffer buffer = filled(100, 2);
  ASSERT_TRUE(buffer.at(1, 0.9, mounting_).hasNormal());
  buffer.clear();
  EXPECT_TRUE(buffer.empty());
  EXPECT_EQ(buffer.at(1, 0.9, mounting_).failure.message(), "not_yet: no imu message");
  EXPECT_FALSE(buffer.covers(1));
}

TEST_F(ImuBufferTest, KeepsAMinute) {
  const ImuBuffer buffer = filled(100, 100);
  expectNormal(buffer.at(41, 40.9, mounting_), 41, 1e-4);
  EXPECT_EQ(buffer.at(30, 29.9, mounting_).failure.message(),
            "not_yet: the oldest imu message is 10 s after the image");
}

TEST_F(ImuBufferTest, NothingIsSaidWithoutMessages) {
  const ImuBuffer buffer(parameters);
  const AttitudePrior prior = buffer.at(1, 0.9, mounting_);
  EXPECT_FALSE(prior.hasNormal());
  EXPECT_FALSE(prior.hasRotation());
  EXPECT_EQ(prior.failure.message(), "not_yet: no imu message");
  EXPECT_FALSE(buffer.covers(0));
}

}  // namespace
}  // namespace uav_landing
