/// What the direct refinement makes of rows that are not level.

#include <gtest/gtest.h>

#include <cmath>

#include "support/refined_pair.h"

namespace uav_landing {
namespace {

using test::kDegree;
using test::RefinedPair;

/// Between two painted lines: the camera sees one lean to the left and one to the right.
RefinedPair betweenLines(unsigned seed, double bend_pixels) {
  RefinedPair scene(seed, 0);
  scene.ground.contrast = 4;
  scene.ground.line_offset = 4;
  scene.ground.line_width = 1;
  scene.ground.bend.x() = bend_pixels / scene.rig.fy;
  return scene;
}

TEST(RefinedRows, IsNotRolledByVerticalDisparitiesThatItIsTold) {
  RefinedPair scene = betweenLines(5, 0.3);
  scene.render();
  const Expected<PlaneFit> untold = scene.refine(scene.truth);
  ASSERT_TRUE(untold);
  scene.rows.w = scene.ground.bend;
  const Expected<PlaneFit> told = scene.refine(scene.truth);
  ASSERT_TRUE(told);
  EXPECT_GT(std::abs(scene.rollError(untold)), 0.1 * kDegree) << "this scene shows nothing";
  EXPECT_LT(std::abs(scene.rollError(told)), 0.2 * std::abs(scene.rollError(untold)));
}

/// Both lines cannot be on one plane with the texture between them while rows are off.
TEST(RefinedRows, FindsVerticalDisparitiesThatItIsNotTold) {
  RefinedPair scene = betweenLines(5, 0.3);
  scene.render();
  const Expected<PlaneFit> untold = scene.refine(scene.truth);
  scene.rows.covariance(0, 0) = scene.rows.covariance(2, 2) = std::pow(0.3 / scene.rig.fy, 2);
  const Expected<PlaneFit> found = scene.refine(scene.truth);
  ASSERT_TRUE(untold && found);
  EXPECT_LT(std::abs(scene.rollError(found)), 0.2 * std::abs(scene.rollError(untold)));
  // The next pairs use what these lines say, too.
  const GroundPlane added{found->plane.g, found->plane.covariance - untold->plane.covariance};
  const GroundPlane lasting{found->plane.g, found->row_covariance};
  const double variance = rollVariance(added.normal(), added.normalCovariance());
  EXPECT_NEAR(rollVariance(lasting.normal(), lasting.normalCovariance()), variance, 0.05 * variance);
}

/// Noise is another one in each pair, and the rows are the same.
TEST(RefinedRows, AreKnownBetterByTheEdgesOfMorePairs) {
  constexpr int kFlights = 12, kPairs = 10;
  const RefinedPair first = betweenLines(700, 0.3);
  DirectRefinement refinement(first.model, 4);
  double squares[2] = {}, claims[2] = {};  // of roll after one pair and after all, rad^2
  for (int i = 0; i < kFlights; ++i) {
    refinement.reset();
    for (int k = 0; k < kPairs; ++k) {
      RefinedPair scene = betweenLines(700 + kPairs * i + k, 0.3);
      scene.rows.covariance(0, 0) = scene.rows.covariance(2, 2) = std::pow(0.3 / scene.rig.fy, 2);
      scene.render({0.5, 50, 7}, {0.45, 60, 7});
      const Expected<PlaneFit> fit =
          refinement.refine(scene.left, scene.right, {scene.truth, scene.rows}, test::groundLimits(), 0);
      ASSERT_TRUE(fit) << i << ", " << k;
      if (k > 0 && k + 1 < kPairs) continue;
      const GroundPlane rows{fit->plane.g, fit->row_covariance};
      squares[k > 0] += std::pow(scene.rollError(fit), 2) / kFlights;
      claims[k > 0] += rollVariance(rows.normal(), rows.normalCovariance()) / kFlights;
    }
  }
  EXPECT_LT(claims[1], 0.5 * claims[0]);
  EXPECT_LT(squares[1], 0.7 * squares[0]);
}

/// Rows that matches have made level since are off by less, and the edges of the pairs before know by how
/// much.
TEST(RefinedRows, OfPairsThatWereLevelledOtherwiseCountAsWell) {
  const double bend = 0.3, taken_out = 0.2;  // pixels
  const auto pair = [](unsigned seed, double pixels) {
    RefinedPair scene = betweenLines(seed, pixels);
    scene.rows.covariance(0, 0) = std::pow(0.3 / scene.rig.fy, 2);
    scene.render();
    return scene;
  };
  const RefinedPair level = pair(830, bend - taken_out);
  const auto rollAfter = [&](const Eigen::Vector3d& levelled_by) {
    DirectRefinement refinement(level.model, 4);
    for (unsigned seed = 820; seed < 828; ++seed) {
      const RefinedPair scene = pair(seed, bend);
      EXPECT_TRUE(
          refinement.refine(scene.left, scene.right, {scene.truth, scene.rows}, test::groundLimits(), 0));
    }
    return level.rollError(refinement.refine(level.left, level.right, {level.truth, level.rows, levelled_by},
                                             test::groundLimits(), 0));
  };
  const double told = rollAfter({taken_out / level.rig.fy, 0, 0}), untold = rollAfter({0, 0, 0});
  EXPECT_LT(std::abs(told), 0.3 * std::abs(untold));
}

/// An alignment that went astray has edges that say anything.
TEST(RefinedRows, OfAPlaneThatIsNotTakenDoNotCount) {
  const auto pair = [](unsigned seed, double pixels) {
    RefinedPair scene = betweenLines(seed, pixels);
    scene.rows.covariance(0, 0) = std::pow(0.05 / scene.rig.fy, 2);
    scene.render();
    return scene;
  };
  const RefinedPair level = pair(860, 0), astray = pair(861, 0.3);
  const auto rollAfter = [&](bool sees, bool forgets) {
    DirectRefinement refinement(level.model, 4);
    const auto refine = [&](const RefinedPair& scene) {
      return refinement.refine(scene.left, scene.right, {scene.truth, scene.rows}, test::groundLimits(), 0);
    };
    if (sees) {
      EXPECT_TRUE(refine(astray));
    }
    if (forgets) refinement.forgetLast();
    return level.rollError(refine(level));
  };
  EXPECT_DOUBLE_EQ(rollAfter(true, true), rollAfter(false, false));
  EXPECT_GT(std::abs(rollAfter(true, false) - rollAfter(false, false)), 0.01 * kDegree);
}

/// Where nothing else tells the rows, one sigma of what is told rolls the plane by the share that lasts.
TEST(RefinedRows, ClaimsWhatTheRowsToldAreWrongBy) {
  RefinedPair scene = betweenLines(5, 0);
  scene.render();
  const double sigma = 0.002 / scene.rig.fy;
  scene.rows.covariance(0, 0) = sigma * sigma;
  const Expected<PlaneFit> claimed = scene.refine(scene.truth);
  scene.rows.w.x() += sigma;
  const Expected<PlaneFit> off = scene.refine(scene.truth);
  ASSERT_TRUE(claimed && off);
  const GroundPlane share{claimed->plane.g, claimed->row_covariance};
  const double stddev = std::sqrt(rollVariance(share.normal(), share.normalCovariance()));
  EXPECT_NEAR(std::abs(scene.rollError(off) - scene.rollError(claimed)), stddev, 0.3 * stddev);
}

/// However clear the lines are: they are drawn sharp, and those of one marking are wrong together.
TEST(RefinedRows, AreNeverKnownBetterByEdgesThanSomeThousandthsOfAPixel) {
  RefinedPair scene = betweenLines(5, 0);
  scene.ground.contrast = 40;
  scene.render();
  const Expected<PlaneFit> known = scene.refine(scene.truth);
  scene.rows.w.x() = 0.01 / scene.rig.fy;
  const Expected<PlaneFit> off = scene.refine(scene.truth);
  scene.rows.w.x() = 0;
  scene.rows.covariance(0, 0) = 1 / (scene.rig.fy * scene.rig.fy);
  const Expected<PlaneFit> by_edges = scene.refine(scene.truth);
  ASSERT_TRUE(known && off && by_edges);
  const double rolled = std::abs(scene.rollError(off) - scene.rollError(known)) / 0.01;  // by a pixel
  const GroundPlane rows{by_edges->plane.g, by_edges->plane.covariance - known->plane.covariance};
  EXPECT_GT(std::sqrt(rollVariance(rows.normal(), rows.normalCovariance())), 0.9 * 0.004 * rolled);
}

/// A row that is off shows ground that is nearer, whether any edge leans or not: inclined rows roll it.
TEST(RefinedRows, IsNotRolledByInclinedRows) {
  RefinedPair scene(5, 0);
  scene.ground.bend.z() = 0.05 * kDegree;
  scene.render();
  const Expected<PlaneFit> untold = scene.refine(scene.truth);
  scene.rows.w = scene.ground.bend;
  const Expected<PlaneFit> told = scene.refine(scene.truth);
  ASSERT_TRUE(untold && told);
  EXPECT_NEAR(std::abs(scene.rollError(untold)), 0.05 * kDegree, 0.02 * kDegree);
  EXPECT_LT(std::abs(scene.rollError(told)), 0.35 * std::abs(scene.rollError(untold)));
}

/// The same where lines are seen in noise.
TEST(RefinedRows, IsNotRolledByVerticalDisparitiesInNoise) {
  constexpr int kPairs = 10;
  double told = 0, untold = 0;
  for (int i = 0; i < kPairs; ++i) {
    RefinedPair scene = betweenLines(500 + i, 0.3);
    scene.render({0.5, 50, 7}, {0.45, 60, 7});
    const Expected<PlaneFit> without = scene.refine(scene.truth);
    scene.rows.w = scene.ground.bend;
    const Expected<PlaneFit> with = scene.refine(scene.truth);
    ASSERT_TRUE(without && with);
    untold += scene.rollError(without) / kPairs;
    told += scene.rollError(with) / kPairs;
  }
  EXPECT_GT(std::abs(untold), 0.1 * kDegree) << "these scenes show nothing";
  EXPECT_LT(std::abs(told), 0.1 * std::abs(untold));
}

}  // namespace
}  // namespace uav_landing
