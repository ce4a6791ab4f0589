#include "lines/vanishing/vanishing_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "lines/vanishing/vanishing_consensus.h"
#include "lines/vanishing/vanishing_search.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

Eigen::Matrix3d makeK() {
  Eigen::Matrix3d K;
  K << 500, 0, 322, 0, 505, 243, 0, 0, 1;
  return K;
}

/// A camera above a runway: what it sees of lines on the ground, with the noise their fit would have.
class Scene {
 public:
  Scene(double yaw, double pitch, double roll, unsigned seed = 1)
      : n(normalFromPitchRoll(pitch, roll)), random_(seed) {
    // The landing direction lies in the ground, `yaw` to the right of the optical axis' trace.
    const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
    direction = Eigen::AngleAxisd(yaw, n) * ahead;
    side_ = n.cross(direction);
  }

  /// Line on the ground at this distance to the side of the camera, `turn` off the landing direction, between
  /// two distances ahead; all in heights. Ends and stated deviations carry noise of `sigma` px.
  LineSegment line(double side, double near, double far, double sigma, double turn = 0) {
    const auto point = [&](double ahead) -> Eigen::Vector2d {
      const Eigen::Vector3d along = Eigen::AngleAxisd(turn, n) * direction;
      return project(n + side * side_ + ahead * along);
    };
    return noisy(point(near), point(far), sigma);
  }
  /// Line across the runway at this distance, heights.
  LineSegment transverse(double ahead, double sigma) {
    const auto point = [&](double side) { return project(n + side * side_ + ahead * direction); };
    return noisy(point(-1.5), point(1.5), sigma);
  }
  /// A segment of any direction.
  LineSegment clutter() {
    const Eigen::Vector2d a(uniform(20, 620), uniform(230, 470));
    const double angle = uniform(0, M_PI), length = uniform(20, 90);
    return noisy(a, a + length * Eigen::Vector2d(std::cos(angle), std::sin(angle)), 0.05);
  }
  /// Offset at the middle and direction are off by independent normal noise, as they say.
  LineSegment noisy(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double sigma) {
    LineSegment segment;
    const Eigen::Vector2d middle = 0.5 * (a + b), along = (b - a).normalized();
    const double half = 0.5 * (b - a).norm();
    segment.offset_stddev = sigma;
    segment.angle_stddev = sigma / half;
    const double offset = sigma * normal_(random_), angle = segment.angle_stddev * normal_(random_);
    const Eigen::Vector2d t = Eigen::Rotation2Dd(angle) * along, across(-t.y(), t.x());
    const Eigen::Vector2d centre = middle + offset * across;
    segment.a = centre - half * t;
    segment.b = centre + half * t;
    segment.line << across, -across.dot(centre);
    return segment;
  }

  /// A runway with edges, centre line and threshold bars.
  std::vector<LineSegment> runway(double sigma) {
    std::vector<LineSegment> lines{line(-1.4, 3, 14, sigma), line(1.5, 3, 14, sigma), line(0.03, 3, 7, sigma),
                                   line(-0.02, 8, 13, sigma)};
    for (int i = 0; i < 6; ++i) lines.push_back(line(-1.05 + 0.4 * i, 2.8, 4, sigma));
    return lines;
  }
  double uniform(double low, double high) { return low + (high - low) * (random_() + 0.5) / 4294967296.0; }

  Eigen::Vector3d n, direction;

 private:
  static Eigen::Vector2d project(const Eigen::Vector3d& X) { return (makeK() * X).hnormalized(); }

  Eigen::Vector3d side_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Squared error in units of the covariance; 2 on average when the covariance is true.
double normalisedError(const VanishingPoint& point, const Eigen::Vector3d& truth) {
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = point.direction.unitOrthogonal();
  B.col(1) = point.direction.cross(B.col(0));
  const Eigen::Vector2d e = B.transpose() * (truth - point.direction);
  return e.dot((B.transpose() * point.covariance * B).inverse() * e);
}

/// Mean normalised error over many noisy views of one scene.
template <class MakeLines>
double meanNormalisedError(double yaw, double pitch, double roll, const ApproachAngleParameters& parameters,
                           const MakeLines& make_lines) {
  double sum = 0;
  int found = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    Scene scene(yaw, pitch, roll, seed);
    const auto point = findVanishingPoint(make_lines(scene), makeK(), parameters);
    if (!point) continue;
    ++found;
    sum += normalisedError(*point, scene.direction);
  }
  EXPECT_GT(found, 290);
  return sum / found;
}

TEST(VanishingPoint, OfExactLinesIsExact) {
  for (const double roll : {-20.0, 0.0, 15.0}) {
    Scene scene(3 * kDegree, -6 * kDegree, roll * kDegree);
    const auto point = findVanishingPoint(scene.runway(1e-6), makeK(), {});
    ASSERT_TRUE(point) << point.error().message();
    EXPECT_LT(angleBetween(point->direction, scene.direction), 1e-7);
    EXPECT_EQ(point->inlier_count, 10);
    EXPECT_NEAR(point->direction.norm(), 1, 1e-12);
    EXPECT_NEAR((point->covariance * point->direction).norm(), 0, 1e-15);
  }
}

TEST(VanishingPoint, CovarianceIsTrueForARunway) {
  // Mean of 300 chi-square variables of 2 degrees of freedom: 2 +- 0.12 (1 sigma). The covariance is scaled
  // up by residuals that happen to be large and never down, which takes up to a fifth off.
  const double error = meanNormalisedError(2 * kDegree, -6 * kDegree, 5 * kDegree, {},
                                           [](Scene& scene) { return scene.runway(0.1); });
  EXPECT_GT(error, 1.3);
  EXPECT_LT(error, 2.35);
}

TEST(VanishingPoint, CovarianceIsTrueFarOutsideTheImage) {
  // 70 degrees to the side the vanishing point is 1400 px from the principal point.
  ApproachAngleParameters parameters;
  parameters.max_yaw_deg = 80;
  const double error = meanNormalisedError(70 * kDegree, -15 * kDegree, 0, parameters, [](Scene& scene) {
    std::vector<LineSegment> lines;
    for (int i = 0; i < 12; ++i)
      lines.push_back(scene.line(-2.5 - 0.3 * i, -1.5 + 0.1 * i, 1 - 0.05 * i, 0.05));
    return lines;
  });
  EXPECT_GT(error, 1.3);
  EXPECT_LT(error, 2.35);
}

TEST(VanishingPoint, CovarianceGrowsWhenLinesDoNotMeetAsWellAsTheySay) {
  const auto optimistic = [](Scene& scene) {
    std::vector<LineSegment> lines = scene.runway(0.15);
    for (LineSegment& line : lines) {
      line.offset_stddev /= 3;
      line.angle_stddev /= 3;
    }
    return lines;
  };
  // Taken at their word the lines would give 9 times 2.
  EXPECT_LT(meanNormalisedError(0, -6 * kDegree, 0, {}, optimistic), 4);
}

TEST(VanishingPoint, IgnoresTransverseLines) {
  Scene scene(2 * kDegree, -8 * kDegree, 4 * kDegree);
  std::vector<LineSegment> lines;
  for (int i = 0; i < 12; ++i) lines.push_back(scene.transverse(3 + 0.3 * i, 0.05));
  for (const LineSegment& line : scene.runway(0.05)) lines.push_back(line);
  const auto point = findVanishingPoint(lines, makeK(), {});
  ASSERT_TRUE(point) << point.error().message();
  EXPECT_LT(angleBetween(point->direction, scene.direction), 0.1 * kDegree);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(point->inliers[i], 0) << i;
  EXPECT_EQ(point->inlier_count, 10);
}

TEST(VanishingPoint, IsNotThePiecesOfOneTransverseLineCrossingAnother) {
  // A hedge just below the horizon (row 154) in ten collinear pieces, longer in all than the runway's lines,
  // and an oblique path that ends on it.
  Scene scene(0, -10 * kDegree, 0);
  std::vector<LineSegment> lines{scene.line(-1.4, 4, 10, 0.05), scene.line(1.5, 4, 10, 0.05),
                                 scene.line(0.03, 3, 7, 0.05)};
  for (int i = 0; i < 10; ++i)
    lines.push_back(scene.noisy({10 + 60.0 * i, 166}, {65 + 60.0 * i, 166.5}, 0.05));
  lines.push_back(scene.noisy({443, 172}, {500, 215}, 0.05));
  const auto point = findVanishingPoint(lines, makeK(), {});
  ASSERT_TRUE(point) << point.error().message();
  EXPECT_LT(angleBetween(point->direction, scene.direction), 0.3 * kDegree);
}

TEST(VanishingPoint, IsNotBelowLinesOnTheGround) {
  // Four lines meet in front of the camera, but the runway goes on above them.
  Scene scene(0, -10 * kDegree, 0);
  std::vector<LineSegment> lines{scene.line(-0.5, 3, 10, 0.05), scene.line(0.5, 3, 10, 0.05),
                                 scene.line(0.03, 3, 10, 0.05), scene.line(-0.2, 3, 10, 0.05)};
  for (const double du : {-200, -60, 60, 200})
    lines.push_back(scene.noisy({322 + 0.1 * du, 363}, {322 + du, 460}, 0.05));
  const auto point = findVanishingPoint(lines, makeK(), {});
  ASSERT_TRUE(point) << point.error().message();
  EXPECT_LT(angleBetween(point->direction, scene.direction), 0.3 * kDegree);
}

TEST(VanishingPoint, IsNotClaimedWhenAllMeetingPointsAreBelowTheLines) {
  Scene scene(0, -10 * kDegree, 0);
  std::vector<LineSegment> lines;
  for (int i = 0; i < 5; ++i) {
    const double lean = 40 * (i - 2.0);
    lines.push_back(scene.noisy({322 + lean, 200}, {322 + 0.3 * lean, 300}, 0.05));  // meet downwards
  }
  EXPECT_FALSE(findVanishingPoint(lines, makeK(), {}));
}

TEST(VanishingPoint, IsFoundAmongClutter) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene(-3 * kDegree, -7 * kDegree, -5 * kDegree, seed);
    std::vector<LineSegment> lines = scene.runway(0.08);
    for (int i = 0; i < 30; ++i) lines.push_back(scene.clutter());
    const auto point = findVanishingPoint(lines, makeK(), {});
    ASSERT_TRUE(point) << point.error().message();
    EXPECT_LT(angleBetween(point->direction, scene.direction), 0.2 * kDegree) << seed;
  }
}

TEST(VanishingPoint, TellsHowManyAreExpectedByChance) {
  Scene scene(-3 * kDegree, -7 * kDegree, -5 * kDegree);
  std::vector<LineSegment> lines = scene.runway(0.08);
  const auto clear = findVanishingPoint(lines, makeK(), {});
  lines.resize(4);
  const auto few = findVanishingPoint(lines, makeK(), {});
  for (int i = 0; i < 5; ++i) lines.push_back(scene.clutter());
  const auto hidden = findVanishingPoint(lines, makeK(), {});
  ASSERT_TRUE(clear && few && hidden);
  EXPECT_LT(clear->coincidences, 1e-6);
  EXPECT_GT(few->coincidences, 10 * clear->coincidences);
  EXPECT_GT(hidden->coincidences, 10 * few->coincidences);
}

TEST(VanishingPoint, IsNotClaimedForLinesOfAnyDirection) {
  int claimed = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Scene scene(0, -7 * kDegree, 0, seed);
    std::vector<LineSegment> lines;
    for (int i = 0; i < 40; ++i) lines.push_back(scene.clutter());
    claimed += findVanishingPoint(lines, makeK(), {}).has_value();
  }
  EXPECT_LE(claimed, 5);
}

TEST(VanishingPoint, NeedsEnoughLines) {
  Scene scene(0, -6 * kDegree, 0);
  const std::vector<LineSegment> lines{scene.line(-1, 3, 10, 0.05), scene.line(1, 3, 10, 0.05)};
  const auto none = findVanishingPoint(lines, makeK(), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message(), "too_few_features: 2 lines of at least 3");
  EXPECT_EQ(findVanishingPoint({}, makeK(), {}).error().message(), "too_few_features: 0 lines of at least 3");
  ApproachAngleParameters two;
  two.min_lines = 2;
  const auto point = findVanishingPoint(lines, makeK(), two);
  ASSERT_TRUE(point) << point.error().message();
  EXPECT_LT(angleBetween(point->direction, scene.direction), 0.2 * kDegree);
}

TEST(VanishingPoint, IsNotDeterminedByTheEdgesOfOneStripe) {
  Scene scene(0, -6 * kDegree, 0);
  std::vector<LineSegment> lines;
  for (int i = 0; i < 6; ++i)
    lines.push_back(scene.line(1 + 0.01 * (i % 2), 3 + 1.5 * i, 4 + 1.5 * i, 0.001));
  const auto none = findVanishingPoint(lines, makeK(), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().reason, Reason::kNoVanishingPoint);
  EXPECT_NE(none.error().detail.find("parallel within"), std::string::npos) << none.error().detail;
}

TEST(VanishingPoint, SaysWhenItIsTooUncertain) {
  Scene scene(0, -15 * kDegree, 0);
  std::vector<LineSegment> lines;
  for (int i = 0; i < 4; ++i) lines.push_back(scene.line(-0.15 + 0.1 * i, 2.0, 2.2, 0.3));
  for (LineSegment& line : lines) line.angle_stddev *= 20;
  const auto none = findVanishingPoint(lines, makeK(), {});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().reason, Reason::kNoVanishingPoint);
}

TEST(VanishingPoint, MustBeAlongTheRunway) {
  Scene scene(40 * kDegree, -6 * kDegree, 0);
  std::vector<LineSegment> lines;
  for (int i = 0; i < 8; ++i) lines.push_back(scene.line(-1 - 0.4 * i, 1, 4, 0.05));
  EXPECT_EQ(findVanishingPoint(lines, makeK(), {}).error().reason, Reason::kNoVanishingPoint);
  ApproachAngleParameters wide;
  wide.max_yaw_deg = 60;
  const auto point = findVanishingPoint(lines, makeK(), wide);
  ASSERT_TRUE(point) << point.error().message();
  EXPECT_LT(angleBetween(point->direction, scene.direction), 0.3 * kDegree);
}

TEST(VanishingPoint, MustLieInTheGroundWhenThatIsKnown) {
  Scene scene(1 * kDegree, -6 * kDegree, 2 * kDegree);
  const std::vector<LineSegment> lines = scene.runway(0.05);
  EXPECT_TRUE(findVanishingPoint(lines, makeK(), {}, &scene.n));
  const Eigen::Vector3d other = normalFromPitchRoll(-14 * kDegree, 2 * kDegree);
  EXPECT_FALSE(findVanishingPoint(lines, makeK(), {}, &other));
}

TEST(VanishingPoint, IsTheSameEachTime) {
  Scene scene(1 * kDegree, -6 * kDegree, 2 * kDegree);
  std::vector<LineSegment> lines = scene.runway(0.1);
  for (int i = 0; i < 60; ++i) lines.push_back(scene.clutter());  // more pairs than are tried
  const auto first = findVanishingPoint(lines, makeK(), {}), second = findVanishingPoint(lines, makeK(), {});
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  EXPECT_EQ(first->direction, second->direction);
  EXPECT_EQ(first->covariance, second->covariance);
  EXPECT_EQ(first->inliers, second->inliers);
}

VanishingPoint pointAt(double yaw, double elevation, double yaw_stddev, double elevation_stddev) {
  VanishingPoint point;
  point.direction << std::sin(yaw) * std::cos(elevation), -std::sin(elevation),
      std::cos(yaw) * std::cos(elevation);
  const Eigen::Vector3d right(std::cos(yaw), 0, -std::sin(yaw)), up = right.cross(point.direction);
  point.covariance = yaw_stddev * yaw_stddev * right * right.transpose() +
                     elevation_stddev * elevation_stddev * up * up.transpose();
  point.inliers = {1, 0, 1, 1};
  point.inlier_count = 3;
  return point;
}

TEST(CombinedVanishingPoint, IsTheMeanWeightedByCovariance) {
  // Left knows the elevation well, right the yaw: variances 1:4 and 4:1.
  const VanishingPoint left = pointAt(0.010, 0.100, 2e-3, 1e-3), right = pointAt(0.012, 0.101, 1e-3, 2e-3);
  const auto mean = combineVanishingPoints(left, right, 0);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(std::atan2(mean->direction.x(), mean->direction.z()), 0.010 + 0.8 * 0.002, 1e-6);
  EXPECT_NEAR(std::asin(-mean->direction.y()), 0.100 + 0.2 * 0.001, 1e-6);
  const Eigen::Vector3d right_hand(std::cos(0.0116), 0, -std::sin(0.0116));
  EXPECT_NEAR(right_hand.dot(mean->covariance * right_hand), 0.8e-6, 1e-9);
  EXPECT_EQ(mean->inlier_count, 6);
  EXPECT_NEAR((mean->covariance * mean->direction).norm(), 0, 1e-15);
}

TEST(CombinedVanishingPoint, AddsTheRunwaysOwnSlopeAndCurveOnce) {
  const VanishingPoint left = pointAt(0.01, 0.1, 1e-3, 1e-3);
  const auto plain = combineVanishingPoints(left, left, 0), curved = combineVanishingPoints(left, left, 3e-3);
  ASSERT_TRUE(plain && curved);
  EXPECT_NEAR(plain->covariance.trace(), 2 * 0.5e-6, 1e-12);
  EXPECT_NEAR(curved->covariance.trace(), 2 * (0.5e-6 + 9e-6), 1e-12);
}

TEST(CombinedVanishingPoint, DoesWithOneView) {
  const VanishingPoint point = pointAt(0.01, 0.1, 1e-3, 1e-3);
  const Expected<VanishingPoint> missing = tl::unexpected(Failure{Reason::kTooFewFeatures, "2 lines"});
  EXPECT_EQ(combineVanishingPoints(point, missing, 0)->direction, point.direction);
  EXPECT_EQ(combineVanishingPoints(missing, point, 0)->direction, point.direction);
  EXPECT_EQ(combineVanishingPoints(missing, missing, 0).error().message(),
            "too_few_features: left: 2 lines; right: 2 lines");
}

TEST(CombinedVanishingPoint, ClaimsLessOrNothingWhenTheViewsDisagree) {
  const VanishingPoint left = pointAt(0.01, 0.0, 1e-3, 1e-3);
  const auto near = combineVanishingPoints(left, pointAt(0.015, 0.0, 1e-3, 1e-3), 0);
  ASSERT_TRUE(near);
  // 5e-3 apart with a variance of 2e-6: 12.5, over the 2 expected.
  EXPECT_NEAR(near->covariance.trace(), 6.25 * 2 * 0.5e-6, 1e-8);
  const auto far = combineVanishingPoints(left, pointAt(0.06, 0.0, 1e-3, 1e-3), 0);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().message(), "no_vanishing_point: left and right differ by 2.9 deg");
}

TEST(NormalFromVanishingPoint, HasTheRollGivenAndHoldsTheDirection) {
  for (const double roll : {-30.0, -5.0, 0.0, 12.0})
    for (const double pitch : {-15.0, 0.0, 8.0})
      for (const double yaw : {-25.0, 0.0, 10.0}) {
        const Scene scene(yaw * kDegree, pitch * kDegree, roll * kDegree);
        VanishingPoint point;
        point.direction = scene.direction;
        point.covariance.setZero();
        const GroundNormal normal = normalFromVanishingPoint(point, roll * kDegree, 0.1).value();
        EXPECT_TRUE(normal.vector().isApprox(scene.n, 1e-12));
        EXPECT_NEAR(rollOf(normal.vector()), roll * kDegree, 1e-14);
        EXPECT_NEAR(pitchOf(normal.vector()), pitch * kDegree, 1e-14);
      }
}

TEST(NormalFromVanishingPoint, CovarianceIsThatOfSamples) {
  const VanishingPoint point = pointAt(0.2, 0.12, 3e-3, 2e-3);
  const double roll = 0.1, roll_stddev = 0.01;
  const GroundNormal normal = normalFromVanishingPoint(point, roll, roll_stddev).value();
  std::mt19937 random(9);
  std::normal_distribution<double> gauss;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const VanishingPoint sample =
        pointAt(0.2 + 3e-3 / std::cos(0.12) * gauss(random), 0.12 + 2e-3 * gauss(random), 1, 1);
    const Eigen::Vector3d d =
        normalFromVanishingPoint(sample, roll + roll_stddev * gauss(random), 0)->vector() - normal.vector();
    spread += d * d.transpose() / kSamples;
  }
  EXPECT_LT((normal.covariance() - spread).norm() / spread.norm(), 0.05);
}

TEST(VanishingConsensus, TriesAllPairsOfFewLinesAndDrawsAmongMany) {
  Scene scene(2 * kDegree, -4 * kDegree, 1 * kDegree);
  std::vector<LineSegment> all = scene.runway(0.01);
  all.push_back(scene.transverse(5, 0.01));
  for (int i = 0; i < 12; ++i) all.push_back(scene.clutter());
  ApproachAngleParameters parameters;
  const auto found = [&](size_t count) {
    const std::vector<LineSegment> some(all.begin(), all.begin() + static_cast<long>(count));
    const VanishingLines lines(some, makeK(), parameters, &scene.n);
    double meetings = 0;
    Eigen::Vector3d anywhere;
    for (int i = 0; i < lines.count(); ++i)
      for (int j = i + 1; j < lines.count(); ++j) meetings += lines.meeting(i, j, anywhere);
    const auto consensus = findConsensus(lines);
    EXPECT_TRUE(consensus &&
                consensus->direction.normalized().dot(scene.direction) > std::cos(0.2 * kDegree));
    return std::make_pair(consensus ? consensus->meetings : 0, meetings);
  };
  // 11 lines have 55 pairs, 23 lines 253.
  parameters.ransac_iterations = 100;
  const auto [counted, meetings] = found(11);
  EXPECT_EQ(counted, meetings);
  const auto [drawn, more] = found(all.size());
  EXPECT_NE(drawn, more) << "an estimate";
  EXPECT_GT(drawn, 0.5 * more);
  EXPECT_LT(drawn, 2.5 * more) << "long lines are drawn more often, and meet along the runway";
}

TEST(VanishingConsensus, DrawsAmongManyLinesUntilItHasMetThoseThatAgree) {
  ApproachAngleParameters parameters;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(2 * kDegree, -7 * kDegree, 0, seed);
    std::vector<LineSegment> all = scene.runway(0.01);
    for (int i = 0; i < 100; ++i) all.push_back(scene.clutter());
    std::rotate(all.begin(), all.begin() + 10 * seed, all.end());
    const VanishingLines lines(all, makeK(), parameters, &scene.n);
    const auto directionBy = [&](int iterations) {
      parameters.ransac_iterations = iterations;
      return findConsensus(lines)->direction.normalized();
    };
    // 110 lines have 5995 pairs.
    EXPECT_LT(angleBetween(directionBy(5995), scene.direction), 0.2 * kDegree) << "of all pairs, " << seed;
    EXPECT_LT(angleBetween(directionBy(5994), scene.direction), 0.2 * kDegree) << "of drawn pairs, " << seed;
  }
}

}  // namespace
}  // namespace uav_landing
