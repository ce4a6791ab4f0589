#include "height/attitude_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kStep = 0.05;  // s

/// Camera that rolls and pitches, seen through noisy normals and noisy rotations between the frames.
class Flight {
 public:
  Flight(unsigned seed, double normal_noise, double rotation_noise)
      : random_(seed), normal_noise_(normal_noise), rotation_noise_(rotation_noise) {}

  Eigen::Matrix3d attitude(int k) const {  // camera from world
    const double t = k * kStep;
    return (Eigen::AngleAxisd(6 * kDegree * std::sin(1.3 * t), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(2 * kDegree * std::sin(2.1 * t + 1), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(3 * kDegree * std::sin(0.9 * t), Eigen::Vector3d::UnitY()))
        .toRotationMatrix();
  }
  Eigen::Vector3d truth(int k) const { return attitude(k) * Eigen::Vector3d::UnitY(); }
  Eigen::Vector3d measured(int k) {
    const Eigen::Vector3d n = truth(k);
    return (n + normal_noise_ * noise().cross(n)).normalized();
  }
  Eigen::Matrix3d covariance(int k) const {
    const Eigen::Vector3d n = truth(k);
    return normal_noise_ * normal_noise_ * (Eigen::Matrix3d::Identity() - n * n.transpose());
  }
  ApproachAngleResult::Motion step(int k) {
    ApproachAngleResult::Motion motion;
    motion.duration = kStep;
    const Eigen::AngleAxisd turn(attitude(k) * attitude(k - 1).transpose());
    motion.rotation = turn.angle() * turn.axis() + rotation_noise_ * noise();
    motion.covariance = Matrix6d::Identity() * rotation_noise_ * rotation_noise_;
    return motion;
  }

 private:
  Eigen::Vector3d noise() { return {normal_(random_), normal_(random_), normal_(random_)}; }
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double normal_noise_, rotation_noise_;
};

TEST(AttitudeFilter, AveragesThroughRotationAndClaimsATrueVariance) {
  constexpr double kNormal = 0.15 * kDegree, kRotation = 0.01 * kDegree;
  double squares = 0, ratios = 0, of_average = 0;
  constexpr int kFlights = 200, kFrames = 60;
  for (unsigned seed = 0; seed < kFlights; ++seed) {
    Flight flight(seed, kNormal, kRotation);
    AttitudeFilter filter;
    AttitudeFilter::Estimate estimate;
    for (int k = 1; k <= kFrames; ++k)
      estimate = filter.update(k * kStep, {flight.measured(k), flight.covariance(k)}, flight.step(k));
    const double error = rollOf(estimate.normal) - rollOf(flight.truth(kFrames));
    squares += error * error / kFlights;
    ratios += error * error / rollVariance(estimate.normal, estimate.covariance) / kFlights;
    of_average += error * error / rollVariance(estimate.normal, estimate.average_covariance) / kFlights;
  }
  // A memory of 20 frames averages 40 in the stationary state: 1 - exp(-1/20) = 1/20.5 of the variance.
  EXPECT_LT(std::sqrt(squares), 0.3 * kNormal);
  EXPECT_GT(std::sqrt(squares), 0.12 * kNormal);
  EXPECT_NEAR(std::sqrt(ratios), 0.8, 0.2) << "fading makes the claim up to 1.4 times too large";
  EXPECT_NEAR(std::sqrt(of_average), 1, 0.15);
}

TEST(AttitudeFilter, ClaimsWhatIsCommonAsLargeAsItWasInThePairsAveraged) {
  // A turned rig tilts the plane the more the higher it is: by 1 sigma here, and from twice to once of it.
  constexpr double kTilt = 0.02 * kDegree;
  constexpr int kFrames = 13;
  Flight flight(1, 0, 1e-6);
  AttitudeFilter filter;
  AttitudeFilter::Estimate estimate;
  const auto size = [](int k) { return kTilt * (2 - static_cast<double>(k) / kFrames); };
  for (int k = 1; k <= kFrames; ++k) {
    const Eigen::Vector3d n = flight.truth(k), across = n.cross(Eigen::Vector3d::UnitX()).normalized();
    const Eigen::Matrix3d own =
        std::pow(0.1 * kDegree, 2) * (Eigen::Matrix3d::Identity() - n * n.transpose());
    const Eigen::Matrix3d common = std::pow(size(k), 2) * across * across.transpose();
    estimate = filter.update(k * kStep, {(n + size(k) * across).normalized(), own}, flight.step(k), common);
  }
  const double error = pitchOf(estimate.normal) - pitchOf(flight.truth(kFrames));
  EXPECT_GT(std::abs(error), 1.3 * size(kFrames));
  const double claimed = std::sqrt(pitchVariance(estimate.normal, estimate.commonCovariance()));
  EXPECT_NEAR(claimed, std::abs(error), 0.03 * std::abs(error));
}

TEST(AttitudeFilter, ClaimsLessForTheAverageOfPairsWhoseErrorsAreNotAllNew) {
  constexpr double kNormal = 0.15 * kDegree, kFresh = 0.75;
  AttitudeFilter all, some;
  AttitudeFilter::Estimate of_all, of_some;
  Flight flight(1, kNormal, 0);
  for (int k = 1; k <= 40; ++k) {
    const Eigen::Vector3d n = flight.measured(k);
    const Eigen::Matrix3d covariance = flight.covariance(k), lasting = (1 - kFresh) * covariance;
    const ApproachAngleResult::Motion step = flight.step(k);
    of_all = all.update(k * kStep, {n, covariance}, step);
    of_some = some.update(k * kStep, {n, covariance}, step, lasting, kFresh);
  }
  const auto roll = [](const AttitudeFilter::Estimate& estimate, const Eigen::Matrix3d& covariance) {
    return rollVariance(estimate.normal, covariance);
  };
  EXPECT_EQ(of_some.normal, of_all.normal);
  EXPECT_NEAR(roll(of_some, of_some.average_covariance), kFresh * roll(of_all, of_all.average_covariance),
              1e-6 * kNormal * kNormal);
  // What lasts does not average out.
  EXPECT_NEAR(roll(of_some, of_some.commonCovariance()), (1 - kFresh) * kNormal * kNormal,
              0.05 * kNormal * kNormal);
}

TEST(AttitudeFilter, FirstPairIsTakenAsItIs) {
  Flight flight(1, 0.1 * kDegree, 0);
  AttitudeFilter filter;
  const Eigen::Vector3d n = flight.measured(1);
  const AttitudeFilter::Estimate estimate = filter.update(1, {n, flight.covariance(1)}, {});
  EXPECT_EQ(estimate.normal, n);
  EXPECT_EQ(estimate.covariance, flight.covariance(1));
  EXPECT_EQ(estimate.average_covariance, flight.covariance(1));
}

TEST(AttitudeFilter, StartsAnewWithoutAStepOfTheRightDurationAndAfterAReset) {
  Flight flight(1, 0.1 * kDegree, 0);
  AttitudeFilter filter;
  filter.update(0.05, {flight.measured(1), flight.covariance(1)}, flight.step(1));
  Eigen::Vector3d n = flight.measured(3);
  EXPECT_EQ(filter.update(0.15, {n, flight.covariance(3)}, flight.step(3)).normal, n) << "a frame is missing";
  n = flight.measured(4);
  ApproachAngleResult::Motion none;
  none.failure = {Reason::kNoMotion, ""};
  EXPECT_EQ(filter.update(0.20, {n, flight.covariance(4)}, none).normal, n);
  filter.reset();
  n = flight.measured(5);
  EXPECT_EQ(filter.update(0.25, {n, flight.covariance(5)}, flight.step(5)).normal, n);
  n = flight.measured(6);
  EXPECT_NE(filter.update(0.30, {n, flight.covariance(6)}, flight.step(6)).normal, n);
}

/// A second of agreeing pairs, and from then on normals of a surface that is tilted by so much.
class TiltedSurface : public testing::Test {
 protected:
  TiltedSurface() {
    for (; k_ <= 20; ++k_) update(0);
  }
  AttitudeFilter::Estimate update(double tilt) { return update(tilt, flight_.step(k_)); }
  AttitudeFilter::Estimate update(double tilt, const ApproachAngleResult::Motion& step) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    seen_ = turn * flight_.measured(k_);
    return filter_.update(k_ * kStep, {seen_, flight_.covariance(k_)}, step);
  }
  double errorOf(const AttitudeFilter::Estimate& estimate) const {
    return std::acos(std::min(1.0, estimate.normal.dot(flight_.truth(k_))));
  }

  Flight flight_{1, 0.05 * kDegree, 0.001 * kDegree};
  AttitudeFilter filter_;
  int k_ = 1;
  Eigen::Vector3d seen_;
};

TEST_F(TiltedSurface, IsLeftOutAndSaidNotToAgree) {
  for (; k_ <= 24; ++k_) {
    const AttitudeFilter::Estimate estimate = update(3 * kDegree);
    EXPECT_FALSE(estimate.agrees);
    EXPECT_LT(errorOf(estimate), 0.05 * kDegree);
  }
  EXPECT_TRUE(update(0).agrees) << "the ground is seen again";
}

TEST_F(TiltedSurface, IsTheGroundWhenItStaysForThreeSeconds) {
  for (; k_ < 80; ++k_) EXPECT_FALSE(update(3 * kDegree).agrees) << k_;
  const AttitudeFilter::Estimate estimate = update(3 * kDegree);
  EXPECT_TRUE(estimate.agrees);
  EXPECT_EQ(estimate.normal, seen_);
}

TEST_F(TiltedSurface, IsToldAlsoWhereTheRotationSinceThePairBeforeIsNot) {
  // 5 deg/s for 0.05 s and 0.3 deg of unevenness: 5 sigma are 2 deg.
  EXPECT_FALSE(update(3 * kDegree, ApproachAngleResult::Motion()).agrees);
  ++k_;
  EXPECT_FALSE(update(3 * kDegree).agrees) << "the pairs before are still remembered";
  ++k_;
  const AttitudeFilter::Estimate estimate = update(0, ApproachAngleResult::Motion());
  EXPECT_TRUE(estimate.agrees);
  EXPECT_EQ(estimate.normal, seen_) << "nothing to average with";
}

TEST_F(TiltedSurface, IsToldAlsoWhereTheRotationSinceClaimsToKnowNothing) {
  ApproachAngleResult::Motion step = flight_.step(k_);
  step.covariance *= 1e8;  // 1 sigma of 10 deg
  EXPECT_FALSE(update(3 * kDegree, step).agrees);
  ++k_;
  EXPECT_TRUE(update(0).agrees);
}

TEST_F(TiltedSurface, IsToldAfterPairsWithoutANormal) {
  for (; k_ < 24; ++k_) filter_.carry(k_ * kStep, flight_.step(k_));
  EXPECT_FALSE(update(3 * kDegree).agrees);
  ++k_;
  const AttitudeFilter::Estimate estimate = update(0);
  EXPECT_TRUE(estimate.agrees);
  EXPECT_LT(errorOf(estimate), 0.05 * kDegree);
}

/// A camera that turns by so much in one step, or is only said to.
class SuddenTurn : public TiltedSurface {
 protected:
  static constexpr double kTurn = 8 * kDegree;

  ApproachAngleResult::Motion turning() {
    ApproachAngleResult::Motion step = flight_.step(k_);
    step.rotation.z() += kTurn;
    return step;
  }
};

TEST_F(SuddenTurn, ThatTheNormalsContradictIsLeftOut) {
  AttitudeFilter::Estimate estimate = update(0, turning());
  EXPECT_TRUE(estimate.agrees);
  EXPECT_LT(errorOf(estimate), 0.2 * kDegree);
  EXPECT_TRUE(filter_.doubtsTurn());
  for (++k_; k_ < 40; ++k_) {
    estimate = update(0);
    EXPECT_TRUE(estimate.agrees) << k_;
    EXPECT_FALSE(filter_.doubtsTurn());
  }
}

TEST_F(SuddenTurn, ThatTheNormalsContradictLaterIsLeftOut) {
  filter_.carry(k_ * kStep, turning());
  EXPECT_TRUE(filter_.doubtsTurn());
  for (++k_; k_ < 24; ++k_) filter_.carry(k_ * kStep, flight_.step(k_));
  EXPECT_TRUE(update(0).agrees);
  ++k_;
  EXPECT_TRUE(update(0).agrees);
  EXPECT_FALSE(filter_.doubtsTurn());
}

TEST_F(SuddenTurn, ThatTheNormalsConfirmIsOne) {
  // From here on the surface appears turned as the step says.
  AttitudeFilter::Estimate estimate = update(kTurn, turning());
  EXPECT_TRUE(estimate.agrees);
  EXPECT_FALSE(filter_.doubtsTurn());
  for (++k_; k_ < 40; ++k_) EXPECT_TRUE(update(kTurn).agrees) << k_;
}

TEST_F(SuddenTurn, IsBelievedAfterFourPairsWithoutANormal) {
  filter_.carry(k_ * kStep, turning());
  for (++k_; k_ < 27; ++k_) filter_.carry(k_ * kStep, flight_.step(k_));
  EXPECT_FALSE(update(0).agrees);
}

TEST_F(TiltedSurface, ThatIsTakenWhereNoStepContradictsIsLeftWhenTheNextNormalsDo) {
  // Within the 2 deg that a camera may turn meanwhile, and claimed to be known well.
  EXPECT_TRUE(update(1.7 * kDegree, ApproachAngleResult::Motion()).agrees);
  for (++k_; k_ < 40; ++k_) {
    const AttitudeFilter::Estimate estimate = update(0);
    EXPECT_TRUE(estimate.agrees) << k_;
    EXPECT_LT(errorOf(estimate), 0.2 * kDegree) << k_;
  }
}

TEST_F(SuddenTurn, ThatTheNormalContradictsAfterAGuessLeavesTheNormalBeforeIt) {
  update(0, ApproachAngleResult::Motion());
  ++k_;
  EXPECT_TRUE(update(2 * kDegree, turning()).agrees) << "with what was before the turn";
  for (++k_; k_ < 30; ++k_) {
    const AttitudeFilter::Estimate estimate = update(0);
    EXPECT_TRUE(estimate.agrees) << k_;
    EXPECT_LT(errorOf(estimate), 0.2 * kDegree) << k_;
  }
}

TEST_F(SuddenTurn, ExcusesNoOtherTilt) {
  EXPECT_FALSE(update(4 * kDegree, turning()).agrees);
  ++k_;
  EXPECT_FALSE(update(4 * kDegree).agrees);
}

TEST_F(TiltedSurface, IsForgottenWithoutAPairForLong) {
  k_ += 80;
  EXPECT_TRUE(update(3 * kDegree, ApproachAngleResult::Motion()).agrees);
}

TEST(AttitudeFilter, OfTheFirstTwoNormalsThatContradictTheLaterOneIsTaken) {
  Flight flight(1, 0.05 * kDegree, 0);
  AttitudeFilter filter;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3 * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int k = 1; k <= 2; ++k)
    filter.update(k * kStep, {turn * flight.measured(k), flight.covariance(k)}, flight.step(k));
  const Eigen::Vector3d n = flight.measured(3);
  const AttitudeFilter::Estimate estimate =
      filter.update(3 * kStep, {n, flight.covariance(3)}, flight.step(3));
  EXPECT_TRUE(estimate.agrees);
  EXPECT_EQ(estimate.normal, n);
}

TEST_F(TiltedSurface, IsFollowedWhenItIsOnlyUneven) {
  const AttitudeFilter::Estimate estimate = update(0.5 * kDegree);
  EXPECT_TRUE(estimate.agrees);
}

TEST(AttitudeFilter, TheCovarianceStaysOneOverAWholeApproach) {
  constexpr double kNormal = 0.01 * kDegree, kRotation = 0.001 * kDegree;
  Flight flight(3, kNormal, kRotation);
  AttitudeFilter filter;
  for (int k = 0; k < 3000; ++k) {
    // Pitch is known better than roll, as by far ground.
    const Eigen::Vector3d n = flight.truth(k), across = n.cross(Eigen::Vector3d::UnitX()).normalized();
    const Eigen::Matrix3d covariance =
        flight.covariance(k) + 4 * kNormal * kNormal * across * across.transpose();
    const auto motion = k > 0 ? flight.step(k) : ApproachAngleResult::Motion();
    const AttitudeFilter::Estimate estimate =
        filter.update(k * kStep, {flight.measured(k), covariance}, motion);
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(estimate.covariance).eigenvalues();
    ASSERT_GT(values[0], -1e-9 * values[2]) << k;
    ASSERT_GT(values[1], 1e-3 * values[2]) << k;
  }
}

}  // namespace
}  // namespace uav_landing
