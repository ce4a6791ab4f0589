#include "integrity/memory/ground_memory.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "support/rigs.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kPitch = -10 * kDegree;
constexpr double kPeriod = 0.05;                // s between pairs
using Surface = std::function<double(double)>;  // elevation over distance, m

StereoRig makeRig() { return test::rigOf({640, 480}, 500, {320, 240}, 320, 1.0); }

/// The pair of a camera at this place over a surface.
std::vector<StereoDepthResult::Point> look(const StereoRig& rig, double x, double z, const Surface& surface) {
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  std::vector<StereoDepthResult::Point> points;
  for (int v = 200; v < 480; v += 10) {
    for (int u = 10; u < 640; u += 20) {
      const Eigen::Vector3d ray = rig.ray(u, v);
      const double a = forward.dot(ray), b = down.dot(ray);
      if (b < 0.02) continue;
      double depth = z / b;
      for (int i = 0; i < 50; ++i) depth = (z - surface(x + a * depth)) / b;
      points.push_back({double(u), double(v), rig.fb() / depth, 0.1, true});
    }
  }
  return points;
}

/// Flies 60 m from a height of 12 m, sinking by 1 m in 20 m, always with the plane z = 0 for the ground
/// ahead. Calls see(x, z, memory) after each pair. without_motion: places at which nobody knows the step.
template <class See>
void flyMemory(const Surface& surface, See&& see, const std::vector<double>& without_motion = {}) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  GroundMemory memory;
  for (double x = 0; x <= 60; ++x) {
    const double z = 12 - x / 20;
    const bool known = std::find(without_motion.begin(), without_motion.end(), x) == without_motion.end();
    if (x > 0 && known) memory.move(Eigen::Matrix3d::Identity(), forward + down / 20, kPeriod);
    if (x > 0 && !known) memory.coast(Eigen::Matrix3d::Identity(), 0.1 * kDegree, kPeriod);
    GroundPlane plane{down / z, 1e-10 * Eigen::Matrix3d::Identity()};
    memory.look(rig, look(rig, x, z, surface), plane, PlaneVector(plane.g));
    see(x, z, memory);
  }
}

/// The same with see(x, z, what is below).
template <class See>
void fly(const Surface& surface, See&& see) {
  flyMemory(surface, [&](double x, double z, const GroundMemory& memory) {
    see(x, z, memory.below(normalFromPitchRoll(kPitch, 0)));
  });
}

// The lowest row looks down by 10 + atan(230 / 500) = 34.7 deg: the nearest ground in view from 12 m is 17.3
// m ahead. The strip is half a height long, its middle some 3 m farther.
constexpr double kFirstSeen = 17.3;

TEST(GroundMemory, KnowsTheHeightAboveGroundThatSlopesAndIsNoLongerInView) {
  // Rises by 1.5 deg up to x = 40, then flat.
  const Surface slope = [](double x) { return std::tan(1.5 * kDegree) * std::min(0.0, x - 40); };
  int known = 0;
  fly(slope, [&](double x, double z, const std::optional<GroundMemory::Below>& below) {
    if (x < kFirstSeen) {
      EXPECT_FALSE(below) << "never in view, " << x;
      return;
    }
    if (x < 24) return;
    ASSERT_TRUE(below) << x;
    ++known;
    EXPECT_NEAR(below->height, z - slope(x), 0.03) << x;
    // 0.15 deg of some 20 m.
    EXPECT_GT(std::sqrt(below->variance), 0.03);
    EXPECT_LT(std::sqrt(below->variance), 0.12);
  });
  EXPECT_GT(known, 30);
}

TEST(GroundMemory, IsThePlaneWhereTheGroundIs) {
  fly([](double) { return 0; },
      [](double x, double z, const std::optional<GroundMemory::Below>& below) {
        if (x > 24) {
          ASSERT_TRUE(below);
          EXPECT_NEAR(below->height, z, 1e-6);
        }
      });
}

struct Errors {
  double mean = 0;                 // m
  double square = 0, claimed = 0;  // m^2
};

/// Means over 120 m of level flight over level ground, with noise on the matches. step: between pairs,
/// m.
Errors flyLevel(double step) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  const GroundPlane plane{down / 12, 1e-10 * Eigen::Matrix3d::Identity()};
  constexpr double kNoise = 1.0;  // px
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const std::vector<StereoDepthResult::Point> exact = look(rig, 0, 12, [](double) { return 0; });
  Errors errors;
  int known = 0;
  GroundMemory memory;
  for (double x = 0; x < 120; x += step) {
    std::vector<StereoDepthResult::Point> points = exact;
    for (StereoDepthResult::Point& point : points) {
      point.disparity += kNoise * normal(random);
      point.disparity_stddev = kNoise;
    }
    memory.move(Eigen::Matrix3d::Identity(), step * forward, kPeriod);
    memory.look(rig, points, plane, PlaneVector(plane.g));
    const std::optional<GroundMemory::Below> below = memory.below(down);
    if (x < 30 || !below) continue;
    errors.mean += below->height - 12;
    errors.square += std::pow(below->height - 12, 2);
    errors.claimed += below->variance;
    ++known;
  }
  EXPECT_GT(known, 50 / step);
  return {errors.mean / known, errors.square / known, errors.claimed / known};
}

TEST(GroundMemory, KnowsGroundThatManyPairsHaveSeenBetterThanByOne) {
  // The patches are 1.2 m apart.
  const Errors one = flyLevel(1.3), many = flyLevel(0.2);
  EXPECT_LT(one.square, one.claimed);
  EXPECT_LT(many.square, many.claimed);
  EXPECT_LT(many.square, 0.5 * one.square);
  // The direction of the motion, by 0.15 deg of 20 m, is uncertain alike.
  const double by_direction = std::pow(0.15 * kDegree * 20, 2);
  EXPECT_LT(many.claimed - by_direction, 0.75 * (one.claimed - by_direction));
}

TEST(GroundMemory, DoesNotTakeGroundForNearerBecauseOfNoise) { EXPECT_NEAR(flyLevel(0.2).mean, 0, 0.03); }

TEST(GroundMemory, KeepsThePathWhereASingleMotionIsWrong) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  const GroundPlane plane{down / 12, 1e-10 * Eigen::Matrix3d::Identity()};
  const auto points = look(rig, 0, 12, [](double) { return 0; });
  GroundMemory memory;
  for (int x = 0; x < 40; ++x) {
    memory.move(Eigen::Matrix3d::Identity(), forward, kPeriod);
    memory.look(rig, points, plane, PlaneVector(plane.g));
  }
  ASSERT_TRUE(memory.below(down));
  // Noise makes one picture seem to go backwards, by more than the distance between patches, 2 m.
  memory.move(Eigen::Matrix3d::Identity(), -2.5 * forward, kPeriod);
  const std::optional<GroundMemory::Below> below = memory.below(down);
  ASSERT_TRUE(below);
  EXPECT_NEAR(below->height, 12, 1e-6);
}

TEST(GroundMemory, TakesTheUsualStepForOneThatCannotBe) {
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  int known = 0;
  const auto jump = [&](double x, double z, GroundMemory memory) {
    if (x < 24) return;
    memory.move(Eigen::Matrix3d::Identity(), -z * down, kPeriod);
    ++known;
    ASSERT_TRUE(memory.below(down));
    EXPECT_NEAR(memory.below(down)->height, z - 1.0 / 20, 0.01) << "sunk as in the pairs before";
  };
  flyMemory([](double) { return 0; }, jump);
  EXPECT_GT(known, 30);
}

TEST(GroundMemory, DoesNotCoastWhereAStepThatCannotBeWent) {
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  int known = 0;
  const auto jump = [&](double x, double z, GroundMemory memory) {
    if (x < 24) return;
    memory.move(Eigen::Matrix3d::Identity(), -z * down, kPeriod);
    memory.coast(Eigen::Matrix3d::Identity(), 0, kPeriod);
    ++known;
    ASSERT_TRUE(memory.below(down));
    // One usual step, and one that is longer, as the speed may have changed, but goes the same way.
    EXPECT_NEAR(memory.below(down)->height, z - 2.5 / 20, 1.0 / 20) << "sinks as in the pairs before";
  };
  flyMemory([](double) { return 0; }, jump);
  EXPECT_GT(known, 30);
}

TEST(GroundMemory, ForgetsWhereThereIsNoMotionToCarryItOnBy) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  GroundMemory memory;
  const GroundPlane plane{down / 12, 1e-10 * Eigen::Matrix3d::Identity()};
  const auto points = look(rig, 0, 12, [](double) { return 0; });
  for (int i = 0; i < 50; ++i) memory.look(rig, points, plane, PlaneVector(plane.g));
  EXPECT_FALSE(memory.below(down)) << "nobody knows where the path goes";
}

TEST(GroundMemory, APairWithoutAMotionCostsCertaintyAndNotTheMemory) {
  const Surface slope = [](double x) { return std::tan(1.5 * kDegree) * std::min(0.0, x - 40); };
  std::vector<double> usual;
  fly(slope, [&](double x, double, const std::optional<GroundMemory::Below>& below) {
    if (x >= 31 && x <= 34) usual.push_back(below->variance);
  });
  size_t i = 0;
  const auto see = [&](double x, double z, const GroundMemory& memory) {
    if (x < 31 || x > 34) return;
    const std::optional<GroundMemory::Below> below = memory.below(normalFromPitchRoll(kPitch, 0));
    ASSERT_TRUE(below) << x;
    EXPECT_NEAR(below->height, z - slope(x), 0.03) << x;
    // 0.1 deg of at least the way left to the nearest patch, some 10 m below and 0 m ahead.
    EXPECT_GT(below->variance, usual[i++] + 0.5 * std::pow(0.1 * kDegree * 10, 2)) << x;
  };
  flyMemory(slope, see, {30, 31});
}

// Twelve pairs are missing, and meanwhile the aircraft begins to sink three times as fast. The ground below
// is carried on over all of that time. Once the second speed is known, both speeds count.
TEST(GroundMemory, CarriesOnOverMissingPairsByTheTimeThatPassed) {
  const Surface slope = [](double x) { return std::tan(1.5 * kDegree) * std::min(0.0, x - 60); };
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  constexpr double kFrom = 30, kTo = 42, kBefore = 0.05, kAfter = 0.15;  // of the way sunk
  GroundMemory memory;
  double z = 12;
  const auto see = [&](double x) {
    const GroundPlane plane{down / z, 1e-10 * Eigen::Matrix3d::Identity()};
    memory.look(rig, look(rig, x, z, slope), plane, PlaneVector(plane.g));
    return memory.below(down);
  };
  see(0);
  std::optional<GroundMemory::Below> before;
  for (double x = 1; x <= kFrom; ++x) {
    z -= kBefore;
    memory.move(Eigen::Matrix3d::Identity(), forward + kBefore * down, kPeriod);
    before = see(x);
  }
  ASSERT_TRUE(before);
  z -= 0.5 * (kBefore + kAfter) * (kTo - kFrom);
  memory.coast(Eigen::Matrix3d::Identity(), 0, (kTo - kFrom) * kPeriod);
  const std::optional<GroundMemory::Below> blind = see(kTo);
  ASSERT_TRUE(blind);
  // As if it had gone on to sink as before.
  const double wrong = 0.5 * (kAfter - kBefore) * (kTo - kFrom);
  EXPECT_NEAR(blind->height, z - slope(kTo) + wrong, 0.03);
  EXPECT_GT(std::sqrt(blind->variance), 0.05 * std::sqrt(kTo - kFrom)) << "5 % of each step of 1 m";
  for (double x = kTo + 1; x <= kTo + 4; ++x) {
    z -= kAfter;
    memory.move(Eigen::Matrix3d::Identity(), forward + kAfter * down, kPeriod);
    const std::optional<GroundMemory::Below> below = see(x);
    ASSERT_TRUE(below) << x;
    EXPECT_NEAR(below->height, z - slope(x), 0.03) << x;
    EXPECT_LT(std::sqrt(below->variance), 0.1) << x;
  }
}

/// Flown up to x = 30 over flat ground, and a step of which the rotation is doubted: 10 deg that were none.
class DoubtedTurn : public testing::Test {
 protected:
  static constexpr double kTurn = 10 * kDegree;

  DoubtedTurn() {
    for (; x_ <= 30; ++x_) {
      if (x_ > 0) memory_.move(Eigen::Matrix3d::Identity(), forward_, kPeriod);
      see();
    }
    const Eigen::Matrix3d wrong = Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitX()).toRotationMatrix();
    memory_.coast(wrong, kTurn, kPeriod, down_, true);
  }
  void see() {
    const GroundPlane plane{down_ / kHeight, 1e-10 * Eigen::Matrix3d::Identity()};
    memory_.look(rig_, look(rig_, x_, kHeight, [](double) { return 0; }), plane, PlaneVector(plane.g));
  }

  static constexpr double kHeight = 12;
  const StereoRig rig_ = makeRig();
  const Eigen::Vector3d down_ = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward_{0, -std::sin(-kPitch), std::cos(kPitch)};
  GroundMemory memory_;
  double x_ = 0;
};

TEST_F(DoubtedTurn, MakesTheGroundBelowAsUncertainAsItIsLarge) {
  memory_.move(Eigen::Matrix3d::Identity(), forward_, kPeriod);
  const std::optional<GroundMemory::Below> below = memory_.below(down_);
  ASSERT_TRUE(below);
  EXPECT_LT(std::abs(below->height - kHeight), 3 * std::sqrt(below->variance));
  EXPECT_GT(std::sqrt(below->variance), kTurn * kHeight);
}

TEST_F(DoubtedTurn, IsSettledByTheNextNormal) {
  memory_.settleTurn(down_, 0.1 * kDegree);
  memory_.move(Eigen::Matrix3d::Identity(), forward_, kPeriod);
  const std::optional<GroundMemory::Below> below = memory_.below(down_);
  ASSERT_TRUE(below);
  EXPECT_NEAR(below->height, kHeight, 0.03);
  EXPECT_LT(std::sqrt(below->variance), 0.1);
}

TEST_F(DoubtedTurn, IsSettledByALaterNormal) {
  for (int i = 0; i < 5; ++i, ++x_) {
    memory_.move(Eigen::Matrix3d::Identity(), forward_, kPeriod);
    EXPECT_GT(memory_.below(down_)->variance, 1) << "nothing has settled it";
    see();
  }
  memory_.settleTurn(down_, 0.1 * kDegree);
  for (int i = 0; i < 30; ++i) {
    memory_.move(Eigen::Matrix3d::Identity(), forward_, kPeriod);
    const std::optional<GroundMemory::Below> below = memory_.below(down_);
    if (!below) break;  // beyond what was seen
    EXPECT_NEAR(below->height, kHeight, 0.05) << i;
    EXPECT_LT(std::sqrt(below->variance), 0.15) << i;
    EXPECT_TRUE(below) << i;
  }
}

TEST_F(DoubtedTurn, DoesNotEraseTheMemoryHoweverOftenItComes) {
  for (int i = 0; i < 6; ++i)
    memory_.coast(Eigen::Matrix3d::Identity(), kTurn, 0.1 * kPeriod, std::nullopt, true);
  EXPECT_TRUE(memory_.below(down_));
}

TEST(GroundMemory, AMotionOverMissingPairsIsNotTooLong) {
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  flyMemory([](double) { return 0; },
            [&](double x, double z, GroundMemory memory) {
              if (x < 24 || x > 40) return;
              memory.move(Eigen::Matrix3d::Identity(), 6 * forward + 6 * down / 10, 6 * kPeriod);
              const std::optional<GroundMemory::Below> below = memory.below(down);
              ASSERT_TRUE(below) << x;
              EXPECT_NEAR(below->height, z - 0.6, 0.01) << "sunk by 1 m in 10 m";
            });
}

TEST(GroundMemory, ForgetsWhereTheMotionStaysUnknown) {
  flyMemory([](double) { return 0.0; },
            [](double x, double, const GroundMemory& memory) {
              if (x < 29 || x > 33) return;
              EXPECT_EQ(memory.below(normalFromPitchRoll(kPitch, 0)).has_value(), x < 33) << x;
            },
            {30, 31, 32, 33});
}

TEST(GroundMemory, AStepThatTheNextOneHasInItIsNoStepOfItsOwn) {
  const StereoRig rig = makeRig();
  const Eigen::Vector3d down = normalFromPitchRoll(kPitch, 0);
  const Eigen::Vector3d forward(0, -std::sin(-kPitch), std::cos(kPitch));
  const Surface step = [](double x) { return x < 40 ? 1.0 : 0.0; };
  GroundMemory memory;
  double known = 0;
  for (int x = 0; x <= 39; ++x) {
    if (x % 2 == 1) {
      memory.wait();
      continue;
    }
    if (x > 0) memory.move(Eigen::Matrix3d::Identity(), 2 * forward, 2 * kPeriod);
    const GroundPlane plane{down / 12, 1e-10 * Eigen::Matrix3d::Identity()};
    memory.look(rig, look(rig, x, 12, step), plane, PlaneVector(plane.g));
    if (const auto below = memory.below(down)) {
      EXPECT_NEAR(below->height, 11, 0.1) << x;
      ++known;
    }
  }
  EXPECT_GT(known, 3);
  for (int i = 0; i < 5; ++i) memory.wait();
  EXPECT_FALSE(memory.below(down)) << "for how long nothing has moved nobody knows";
}

}  // namespace
}  // namespace uav_landing
