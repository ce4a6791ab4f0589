#include "uav_landing/stereo/direct_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <string>

#include "support/consistency.h"
#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace {

using test::Exposure;
using test::GroundRenderer;
using test::kDegree;
using test::makePose;
using test::Pose;

PlaneLimits makeLimits() {
  PlaneLimits limits;
  limits.max_roll = limits.max_pitch = 30 * kDegree;
  limits.min_points = 20;
  return limits;
}

/// A rig over textured ground.
struct Scene {
  StereoRig rig = test::makeRig(320, 240, 0.65);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{5};
  Pose pose = makePose(4, -8, 3);
  Eigen::Vector3d truth = pose.down() / pose.height();
  cv::Mat left, right;
  RigRotation rows = test::levelRows();

  void render(const Exposure& of_left = {}, const Exposure& of_right = {}) {
    left = ground.left(rig, pose, of_left);
    right = ground.right(rig, pose, of_right);
  }
  /// The true plane with its disparities off by some pixels and a share.
  Eigen::Vector3d off(double pixels, double share) const {
    return truth * (1 + share) + Eigen::Vector3d(0, 0, pixels / rig.fb());
  }
  Expected<PlaneFit> refine(const Eigen::Vector3d& start) const {
    return DirectRefinement(model, 4).refine(left, right, start, makeLimits(), 0, rows);
  }
  /// Largest error of the disparity over the ground's part of the image, pixels.
  double error(const Eigen::Vector3d& g) const {
    double largest = 0;
    for (const int v : {120, 239}) {
      for (const int u : {0, 319}) {
        largest = std::max(largest, std::abs(rig.fb() * (g - truth).dot(rig.ray(u, v))));
      }
    }
    return largest;
  }
};

TEST(DirectRefinement, FindsThePlaneFromAFractionOfAPixelOff) {
  Scene scene;
  scene.render();
  for (const double pixels : {-0.5, 0.0, 0.4}) {
    for (const double share : {-0.005, 0.0, 0.005}) {
      const Expected<PlaneFit> fit = scene.refine(scene.off(pixels, share));
      ASSERT_TRUE(fit) << fit.error().message();
      EXPECT_LT(scene.error(fit->plane.g), 0.05) << pixels << ' ' << share;
    }
  }
  EXPECT_GT(scene.error(scene.off(0.4, 0.005)), 0.4);
}

TEST(DirectRefinement, IsBlindToGainOffsetAndVignetting) {
  Scene scene;
  scene.render();
  const Expected<PlaneFit> plain = scene.refine(scene.off(0.2, 0));
  scene.render({1.05, 3, 1}, {0.9, -6, 1});
  for (int v = 0; v < scene.right.rows; ++v) {
    for (int u = 0; u < scene.right.cols; ++u) {
      // A quarter darker in the corners.
      const double radius = std::hypot(u - 160, v - 120) / 200;
      uchar& grey = scene.right.at<uchar>(v, u);
      grey = cv::saturate_cast<uchar>(grey * (1 - 0.25 * radius * radius));
    }
  }
  const Expected<PlaneFit> altered = scene.refine(scene.off(0.2, 0));
  ASSERT_TRUE(plain && altered);
  EXPECT_LT(scene.error(plain->plane.g), 0.05);
  EXPECT_LT(scene.error(altered->plane.g), 0.05);
}

TEST(DirectRefinement, IsNotPulledByWhatStandsOnTheGround) {
  Scene scene;
  scene.ground.boxes = {
      {{8, -3, 0}, {9, -1.5, 0.6}}, {{11, 1, 0}, {13, 3, 0.4}}, {{6, 1.5, 0}, {7, 2.5, 0.3}}};
  scene.render();
  const Expected<PlaneFit> fit = scene.refine(scene.off(0.1, 0));
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(scene.error(fit->plane.g), 0.08);
}

TEST(DirectRefinement, ClaimsACovarianceThatIsTrue) {
  constexpr int kPairs = 40;
  double sum = 0;
  for (int i = 0; i < kPairs; ++i) {
    Scene scene;
    scene.ground = GroundRenderer(100 + i);
    scene.pose = makePose(3 + 0.05 * i, -8, 0.2 * i - 4);
    scene.truth = scene.pose.down() / scene.pose.height();
    scene.render({1, 0, 4}, {1, 0, 4});
    const Expected<PlaneFit> fit = scene.refine(scene.off(0.1, 0));
    ASSERT_TRUE(fit) << fit.error().message();
    const Eigen::Vector3d error = fit->plane.g - scene.truth;
    sum += error.dot(fit->plane.covariance.ldlt().solve(error));
  }
  // The inflation for correlated errors is never below 1, so that the claim is on the careful side.
  EXPECT_LT(sum / kPairs, 3 + test::chiSquareMeanTolerance(kPairs, 3));
  EXPECT_GT(sum / kPairs, 1.0);
}

/// Each block alone tells next to nothing here: an average of their shifts would hardly be better.
TEST(DirectRefinement, UsesFaintTextureEverywhere) {
  constexpr int kPairs = 20;
  double squares = 0;
  for (int i = 0; i < kPairs; ++i) {
    Scene scene;
    scene.ground = GroundRenderer(200 + i);
    scene.render({0.25, 80, 5}, {0.25, 80, 5});
    const Expected<PlaneFit> fit = scene.refine(scene.off(0.2, 0));
    ASSERT_TRUE(fit) << fit.error().message();
    squares += std::pow(scene.error(fit->plane.g), 2);
  }
  EXPECT_LT(std::sqrt(squares / kPairs), 0.135) << "px";
}

/// Coarse texture close below in much noise: gradients of the whole images are hardly more than that.
TEST(DirectRefinement, SeesCoarseTextureThroughMuchNoise) {
  constexpr int kPairs = 24;
  double squares = 0, normalised = 0;
  for (int i = 0; i < kPairs; ++i) {
    Scene scene;
    scene.ground = GroundRenderer(400 + i);
    scene.ground.grain = 0.04;
    scene.pose = makePose(1.2, -8, 3);
    scene.truth = scene.pose.down() / scene.pose.height();
    scene.render({0.3, 80, 8}, {0.3, 80, 8});
    const Expected<PlaneFit> fit = scene.refine(scene.off(0.2, 0));
    ASSERT_TRUE(fit) << fit.error().message();
    const double error = fit->plane.height() - scene.pose.height();
    squares += error * error;
    normalised += error * error / fit->plane.heightVariance();
  }
  EXPECT_LT(std::sqrt(squares / kPairs), 0.005) << "m";
  EXPECT_LT(normalised / kPairs, 1 + test::chiSquareMeanTolerance(kPairs, 1));
}

TEST(DirectRefinement, FindsTheSameInAPairWhateverCameBefore) {
  Scene clear, faint;
  clear.render();
  faint.render({0.25, 80, 5}, {0.25, 80, 5});
  DirectRefinement refinement(clear.model, 4);
  for (const Scene* scene : {&faint, &clear, &faint, &clear}) {
    const Eigen::Vector3d start = scene->off(0.2, 0);
    const Expected<PlaneFit> fit =
        refinement.refine(scene->left, scene->right, start, makeLimits(), 0, scene->rows);
    const Expected<PlaneFit> alone = scene->refine(start);
    ASSERT_TRUE(fit && alone);
    EXPECT_EQ(fit->plane.g, alone->plane.g);
    EXPECT_EQ(fit->plane.covariance, alone->plane.covariance);
    EXPECT_GT(refinement.agreement(), 0.8);
  }
}

TEST(DirectRefinement, TakesFaintImagesOfOddSize) {
  Scene scene;
  scene.rig.size = cv::Size(319, 239);
  scene.model = test::makeModel(scene.rig);
  scene.render({0.25, 80, 5}, {0.25, 80, 5});
  const Expected<PlaneFit> fit = scene.refine(scene.off(0.2, 0));
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(scene.error(fit->plane.g), 0.4);
}

TEST(DirectRefinement, RefusesImagesTooSmallForABlock) {
  Scene scene;
  scene.rig.size = cv::Size(20, 1);
  scene.model = test::makeModel(scene.rig);
  scene.render();
  const Expected<PlaneFit> fit = scene.refine(scene.truth);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().reason, Reason::kTooFewMatches);
}

TEST(DirectRefinement, ForgetsItsStartWhereMostBlocksAreNoise) {
  Scene scene;
  scene.ground.line_offset = 1;
  scene.render({0.2, 90, 5}, {0.2, 90, 5});
  const Expected<PlaneFit> above = scene.refine(scene.off(0.4, 0)), below = scene.refine(scene.off(-0.4, 0));
  ASSERT_TRUE(above && below);
  EXPECT_LT((above->plane.g - below->plane.g).norm() * scene.rig.fb(), 0.22) << "of 0.8 px";
}

/// Between two painted lines the camera sees one lean to the left and one to the right.
TEST(DirectRefinement, IsNotRolledByVerticalDisparitiesThatItIsTold) {
  Scene scene;
  scene.pose = makePose(4, -8, 0);
  scene.truth = scene.pose.down() / scene.pose.height();
  scene.ground.contrast = 4;
  scene.ground.line_offset = 4;
  scene.ground.line_width = 1;
  scene.ground.bend.x() = 0.3 / scene.rig.fy;
  scene.render();
  const auto rollError = [&](const Expected<PlaneFit>& fit) {
    return rollOf(fit->plane.normal()) - rollOf(scene.truth.normalized());
  };
  const Expected<PlaneFit> untold = scene.refine(scene.truth);
  ASSERT_TRUE(untold);
  scene.rows.w = scene.ground.bend;
  const Expected<PlaneFit> told = scene.refine(scene.truth);
  ASSERT_TRUE(told);
  EXPECT_GT(std::abs(rollError(untold)), 0.1 * kDegree) << "this scene shows nothing";
  EXPECT_LT(std::abs(rollError(told)), 0.2 * std::abs(rollError(untold)));

  // One sigma more of rotation rolls the plane by one sigma of the rows' share.
  const double sigma = 0.02 / scene.rig.fy;
  scene.rows.covariance(0, 0) = sigma * sigma;
  const Expected<PlaneFit> claimed = scene.refine(scene.truth);
  scene.rows.w.x() += sigma;
  const Expected<PlaneFit> off = scene.refine(scene.truth);
  ASSERT_TRUE(claimed && off);
  const GroundPlane share{claimed->plane.g, claimed->row_covariance};
  const double stddev = std::sqrt(rollVariance(share.normal(), share.normalCovariance()));
  EXPECT_NEAR(std::abs(rollError(off) - rollError(claimed)), stddev, 0.3 * stddev);
  EXPECT_TRUE(claimed->plane.covariance.isApprox(told->plane.covariance + claimed->row_covariance));
}

/// The same where lines are seen in noise.
TEST(DirectRefinement, IsNotRolledByVerticalDisparitiesInNoise) {
  constexpr int kPairs = 10;
  double told = 0, untold = 0;
  for (int i = 0; i < kPairs; ++i) {
    Scene scene;
    scene.pose = makePose(4, -8, 0);
    scene.truth = scene.pose.down() / scene.pose.height();
    scene.ground = GroundRenderer(500 + i);
    scene.ground.contrast = 4;
    scene.ground.line_offset = 4;
    scene.ground.line_width = 1;
    scene.ground.bend.x() = 0.3 / scene.rig.fy;
    scene.render({0.5, 50, 7}, {0.45, 60, 7});
    const auto rollError = [&](const Expected<PlaneFit>& fit) {
      return rollOf(fit->plane.normal()) - rollOf(scene.truth.normalized());
    };
    const Expected<PlaneFit> without = scene.refine(scene.truth);
    scene.rows.w = scene.ground.bend;
    const Expected<PlaneFit> with = scene.refine(scene.truth);
    ASSERT_TRUE(without && with);
    untold += rollError(without) / kPairs;
    told += rollError(with) / kPairs;
  }
  EXPECT_GT(std::abs(untold), 0.1 * kDegree) << "these scenes show nothing";
  EXPECT_LT(std::abs(told), 0.2 * std::abs(untold));
}

TEST(DirectRefinement, HasTooFewMatchesWithoutTexture) {
  Scene scene;
  const auto expectTooFew = [&](const std::string& count) {
    const Expected<PlaneFit> fit = scene.refine(scene.truth);
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().reason, Reason::kTooFewMatches);
    EXPECT_EQ(fit.error().detail, count + " blocks match, at least 20 needed");
  };
  scene.left = scene.right = cv::Mat(240, 320, CV_8U, cv::Scalar(90));
  expectTooFew("0");
  // Steps of one grey level every four columns have less contrast than a block must have.
  scene.left.forEach<uchar>([](uchar& grey, const int* place) { grey += place[1] / 4 % 2; });
  scene.right = scene.left.clone();
  expectTooFew("0");
}

TEST(DirectRefinement, HasTooFewMatchesWithTextureInOnePlaceOnly) {
  Scene scene;
  scene.render();
  // At most four by four blocks of 16 x 8 pixels see some of it.
  const cv::Rect place(120, 180, 40, 20);
  cv::Mat left(240, 320, CV_8U, cv::Scalar(90));
  scene.left(place).copyTo(left(place));
  scene.left = left;
  const Expected<PlaneFit> fit = scene.refine(scene.truth);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().reason, Reason::kTooFewMatches);
  EXPECT_NE(fit.error().detail.find(" blocks match, at least 20 needed"), std::string::npos);
  EXPECT_GE(std::stoi(fit.error().detail), 1);
  EXPECT_LE(std::stoi(fit.error().detail), 16);
}

TEST(DirectRefinement, FindsNoPlaneInNoiseAlone) {
  Scene scene;
  scene.ground.contrast = 0;
  scene.render({1, 0, 6}, {1, 0, 6});
  EXPECT_FALSE(scene.refine(scene.truth));
}

TEST(SamePlane, AllowsFiveSigmasBetweenThePlanes) {
  const Pose pose = makePose(10, -4, 0);
  const GroundPlane plane = test::exactPlane(pose, 0.01, 0.001);
  // Both planes have the same covariance: 1 sigma of the difference is 1.41 % of the height, 1.41 mrad of
  // tilt.
  const double sigma = std::sqrt(2.0);
  const Eigen::Vector3d by_height = 0.01 * plane.g;
  const Eigen::Vector3d by_tilt = 0.001 * plane.g.norm() * pose.seen(Eigen::Vector3d::UnitX());
  for (const Eigen::Vector3d& change : {by_height, by_tilt})
    for (const double side : {-1.0, 1.0}) {
      GroundPlane other = plane;
      other.g = plane.g + 4.9 * side * sigma * change;
      EXPECT_TRUE(samePlane(plane, other));
      other.g = plane.g + 5.1 * side * sigma * change;
      EXPECT_FALSE(samePlane(plane, other));
    }
}

}  // namespace
}  // namespace uav_landing
