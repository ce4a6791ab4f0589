#include "landing/watch/velocity_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/degree.h"
#include "support/landing_parts.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::kStep;

constexpr double kHeight = 10, kWindow = 0.5;

/// A level camera that moves by so many metres ahead, down and aside from pair to pair.
class Flight {
 public:
  PairTests tests = test::noTests();  // of the last pair
  double turn = 0;                    // about the camera's down axis, from pair to pair, rad
  VelocityWatch watch{1.0};

  VelocityWatch::Verdict fly(double ahead, double down, double aside = 0) {
    ApproachAngleResult approach = test::withoutTurning(stamp_);
    approach.n = Eigen::Vector3d::UnitY();
    approach.n_covariance = 1e-8 * Eigen::Matrix3d::Identity();
    approach.step.rotation = {0, turn, 0};
    approach.step.translation_over_height = Eigen::Vector3d(aside, down, ahead) / kHeight;
    approach.step.covariance = 1e-8 * Matrix6d::Identity();
    approach.step.angle = std::atan2(down, std::hypot(ahead, aside));
    approach.step.angle_variance = 1e-6;
    approach.window = approach.step;
    approach.window.duration = kWindow;
    return follow(approach);
  }
  VelocityWatch::Verdict flyWithoutMotion() { return follow(test::angleAt(stamp_)); }
  /// 20 m/s.
  void flySteadily(int pairs = 10) {
    for (int i = 0; i < pairs; ++i) fly(2, 0.02);
  }
  bool possible() const { return tests.result(IntegrityTest::kVelocity).possible(); }
  bool failed() const { return tests.failed(IntegrityTest::kVelocity); }

 private:
  VelocityWatch::Verdict follow(const ApproachAngleResult& approach) {
    stamp_ += kStep;
    tests = test::noTests();
    return watch.follow(test::pairOf(approach), kHeight, 0, tests);
  }

  double stamp_ = 1;
};

void expectNoDoubt(const VelocityWatch::Verdict& verdict) {
  EXPECT_EQ(verdict.path_doubt, 0);
  EXPECT_EQ(verdict.step_doubt, 0);
}

TEST(VelocityWatch, ComparesAStepWithThreeThatAgree) {
  Flight flight;
  for (int i = 0; i < 6; ++i) {
    expectNoDoubt(flight.fly(2, 0.02));
    EXPECT_EQ(flight.possible(), i >= 3) << i;
    EXPECT_FALSE(flight.failed());
  }
}

// Matches that are one period of 4 m too far.
TEST(VelocityWatch, AnAngleIsAsUncertainAsAStepThatIsTooLongChangesIt) {
  const double off = std::atan2(0.02, 2) - std::atan2(0.02, 6);
  Flight flight;
  flight.flySteadily();
  const VelocityWatch::Verdict verdict = flight.fly(6, 0.02);
  EXPECT_TRUE(flight.failed());
  EXPECT_NEAR((verdict.change - Eigen::Vector3d(0, 0, 40)).norm(), 0, 0.01) << "m/s";
  EXPECT_NEAR(verdict.step_doubt, off, 1e-6);
  EXPECT_NEAR(verdict.path_doubt, off, 1e-6);
}

TEST(VelocityWatch, ThePathIsDoubtedForAsLongAsTheStepIsInItsWindow) {
  Flight flight;
  flight.flySteadily();
  const double doubt = flight.fly(6, 0.02).path_doubt;
  int pairs = 0;
  for (VelocityWatch::Verdict verdict = flight.fly(2, 0.02); verdict.path_doubt > 0 && pairs < 40; ++pairs) {
    EXPECT_EQ(verdict.path_doubt, doubt);
    EXPECT_EQ(verdict.step_doubt, 0) << "this one agrees";
    EXPECT_FALSE(flight.failed());
    verdict = flight.fly(2, 0.02);
  }
  EXPECT_NEAR(pairs * kStep, kWindow, 1.01 * kStep);
}

TEST(VelocityWatch, TheTimeOfPairsWithoutMotionCountsAsWell) {
  Flight flight;
  flight.flySteadily();
  flight.fly(6, 0.02);
  for (int i = 0; i < 4; ++i) EXPECT_GT(flight.flyWithoutMotion().path_doubt, 0) << i;
  for (int i = 0; i < 2; ++i) flight.flyWithoutMotion();
  EXPECT_EQ(flight.flyWithoutMotion().path_doubt, 0);
}

TEST(VelocityWatch, APictureOnceMoreKeepsTheDoubtOfThePathAndHasNoStep) {
  Flight flight;
  flight.flySteadily();
  const double doubt = flight.fly(6, 0.02).path_doubt;
  EXPECT_EQ(flight.watch.verdict().path_doubt, doubt);
  EXPECT_EQ(flight.watch.verdict().step_doubt, 0);
}

TEST(VelocityWatch, OfSeveralStepsThatContradictTheWorstOneCountsForThePath) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.fly(2, 0.2);
  const double worst = flight.fly(6, 0.2).step_doubt;
  const VelocityWatch::Verdict verdict = flight.fly(4, 0.2);
  EXPECT_LT(verdict.step_doubt, worst + 1e-9);
  EXPECT_EQ(verdict.path_doubt, worst);
}

TEST(VelocityWatch, ADoubtThatIsOverIsNotThatOfTheNextContradiction) {
  Flight flight;
  for (int i = 0; i < 10; ++i) flight.fly(2, 0.2);
  const double worse = flight.fly(6, 0.2).path_doubt;
  for (int i = 0; i < 10; ++i) flight.fly(2, 0.2);
  const VelocityWatch::Verdict verdict = flight.fly(4, 0.2);
  EXPECT_TRUE(flight.failed());
  EXPECT_LT(verdict.path_doubt, 0.8 * worse);
}

TEST(VelocityWatch, AStepOfAnUnusualTurnSaysNothing) {
  Flight flight;
  flight.flySteadily();
  flight.turn = 30 * kDegree * kStep;
  expectNoDoubt(flight.fly(6, 0.02));
  EXPECT_FALSE(flight.possible());
  flight.turn = 0;
  flight.fly(2, 0.02);
  EXPECT_TRUE(flight.possible());
  EXPECT_FALSE(flight.failed()) << "nor has it turned the velocity";
}

TEST(VelocityWatch, AVelocityThatTurnsWithTheCameraIsTheSame) {
  Flight flight;
  flight.flySteadily();
  // The scene turns against the camera: what came from ahead comes from the right then.
  flight.turn = 20 * kDegree * kStep;
  flight.fly(2 * std::cos(flight.turn), 0.02, 2 * std::sin(flight.turn));
  EXPECT_TRUE(flight.possible());
  EXPECT_FALSE(flight.failed());
  flight.fly(2, 0.02, -2);
  EXPECT_TRUE(flight.failed());
}

}  // namespace
}  // namespace uav_landing
