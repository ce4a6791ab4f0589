#include "stereo/photometric/direct_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/consistency.h"
#include "support/refined_pair.h"
#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::makePose;
using test::Pose;
using test::RefinedPair;

/// It ends before it has settled, and says so.
TEST(DirectRefinement, ClaimsWhatABriefOneLeavesUnsettled) {
  constexpr int kPairs = 10;
  double normalised = 0;
  for (int i = 0; i < kPairs; ++i) {
    RefinedPair scene(20 + i);
    scene.render({0.3, 90, 2}, {0.3, 90, 2});
    RefinementStart start{scene.off(i % 2 ? 1.2 : -1.2, 0), scene.rows};
    const auto refined = [&] {
      return DirectRefinement(scene.model, 4).refine(scene.left, scene.right, start, test::groundLimits(), 0);
    };
    const Expected<PlaneFit> settled = refined();
    start.brief = true;
    const Expected<PlaneFit> brief = refined();
    ASSERT_TRUE(settled && brief);
    const Eigen::Vector3d error = brief->plane.g - scene.truth.vector();
    normalised += error.dot(brief->plane.covariance.ldlt().solve(error)) / (3 * kPairs);
    const double moved = std::pow((brief->plane.g - settled->plane.g).z(), 2);
    EXPECT_GE(brief->plane.covariance(2, 2), settled->plane.covariance(2, 2) + moved) << i;
  }
  EXPECT_LT(normalised, 1.8);
}

TEST(DirectRefinement, FindsThePlaneFromAFractionOfAPixelOff) {
  RefinedPair scene;
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

// Where g changes along z only, all rows of a rolling shutter together show another plane: the one that the
// images are rendered with.
TEST(DirectRefinement, OfARollingShutterFindsThePlaneAtTheStamp) {
  RefinedPair scene;
  scene.render();
  const RowTimes times(test::calibrationOf(scene.rig), {0.03, 0});
  const double rate = 3 / (scene.rig.fb() * times.readoutTime());  // 1/m/s: 3 px in a readout
  const Eigen::Vector3d& t = times.plane();
  const Eigen::Vector3d by_rows = rate * Eigen::Vector3d(0, t[2] * scene.rig.fy, t[0] + t[2] * scene.rig.cy);
  const Eigen::Vector3d at_stamp = scene.truth.vector() - by_rows;
  for (const double pixels : {-0.3, 0.0}) {
    RefinementStart start{PlaneVector(scene.off(pixels, 0).vector() - by_rows), scene.rows};
    start.drift = {{0, 0, rate}, &times};
    const Expected<PlaneFit> fit =
        DirectRefinement(scene.model, 4).refine(scene.left, scene.right, start, test::groundLimits(), 0);
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_LT(scene.error(scene.truth.vector() + fit->plane.g - at_stamp), 0.05) << pixels;
  }
}

TEST(DirectRefinement, IsBlindToGainOffsetAndVignetting) {
  RefinedPair scene;
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

TEST(DirectRefinement, LooksAtNothingUnderAMaskNarrowerThanABlock) {
  const auto planeBesideStruts = [](int seed) {
    RefinedPair scene;
    scene.render();
    for (int u = 20; u < scene.left.cols; u += 37) {
      scene.model.left_mask.col(u) = 0;
      cv::RNG(static_cast<uint64>(seed + u)).fill(scene.left.col(u), cv::RNG::UNIFORM, 0, 255);
    }
    const Expected<PlaneFit> fit = scene.refine(scene.off(0.2, 0));
    return fit ? fit->plane.g : Eigen::Vector3d::Zero().eval();
  };
  const Eigen::Vector3d one = planeBesideStruts(1);
  EXPECT_GT(one.norm(), 0);
  EXPECT_EQ(one, planeBesideStruts(1000));
}

TEST(DirectRefinement, TellsHowMuchOfTheErrorIsNoNoise) {
  // A lens that is off by so many pixels here and there.
  const auto shareOf = [](double noise, double lens) {
    RefinedPair scene;
    scene.render({1, 0, noise}, {1, 0, noise});
    cv::Mat columns(scene.right.size(), CV_32F), rows(scene.right.size(), CV_32F);
    for (int v = 0; v < rows.rows; ++v) {
      for (int u = 0; u < rows.cols; ++u) {
        columns.at<float>(v, u) = static_cast<float>(u + lens * std::sin(u / 9.0) * std::sin(v / 7.0));
        rows.at<float>(v, u) = static_cast<float>(v);
      }
    }
    cv::remap(scene.right, scene.right, columns, rows, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    const Expected<PlaneFit> fit = scene.refine(scene.truth);
    EXPECT_TRUE(fit);
    return fit ? fit->lasting_share : 0;
  };
  EXPECT_LT(shareOf(2, 0), 0.3);
  EXPECT_GT(shareOf(1, 0.3), 0.7);
  EXPECT_LT(shareOf(6, 0.1), shareOf(1, 0.1));
}

TEST(DirectRefinement, IsNotPulledByWhatStandsOnTheGround) {
  RefinedPair scene;
  scene.ground.boxes = {
      {{8, -3, 0}, {9, -1.5, 0.6}}, {{11, 1, 0}, {13, 3, 0.4}}, {{6, 1.5, 0}, {7, 2.5, 0.3}}};
  scene.render();
  const Expected<PlaneFit> fit = scene.refine(scene.off(0.1, 0));
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(scene.error(fit->plane.g), 0.08);
}

// Rows that nobody has measured are found from slanted edges of the ground. Edges of what stands on it would
// tell others.
TEST(DirectRefinement, RowsAreNotTurnedByWhatStandsOnTheGround) {
  RefinedPair scene;
  scene.rows.covariance = Eigen::Matrix3d::Identity() * 4e-6;
  for (int i = 0; i < 6; ++i)
    scene.ground.boxes.push_back({{7 + 1.5 * i, 1 + 0.4 * i, 0}, {8 + 1.5 * i, 3 + 0.4 * i, 0.5}});
  scene.render();
  const Expected<PlaneFit> fit = scene.refine(scene.off(0.1, 0));
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(scene.error(fit->plane.g), 0.035);
}

TEST(DirectRefinement, ClaimsACovarianceThatIsTrue) {
  constexpr int kPairs = 40;
  double sum = 0;
  for (int i = 0; i < kPairs; ++i) {
    RefinedPair scene;
    scene.ground = GroundRenderer(100 + i);
    scene.pose = makePose(3 + 0.05 * i, -8, 0.2 * i - 4);
    scene.truth = PlaneVector(scene.pose.down() / scene.pose.height());
    scene.render({1, 0, 4}, {1, 0, 4});
    const Expected<PlaneFit> fit = scene.refine(scene.off(0.1, 0));
    ASSERT_TRUE(fit) << fit.error().message();
    const Eigen::Vector3d error = fit->plane.g - scene.truth.vector();
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
    RefinedPair scene;
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
    RefinedPair scene;
    scene.ground = GroundRenderer(400 + i);
    scene.ground.grain = 0.04;
    scene.pose = makePose(1.2, -8, 3);
    scene.truth = PlaneVector(scene.pose.down() / scene.pose.height());
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
  RefinedPair clear, faint;
  clear.render();
  faint.render({0.25, 80, 5}, {0.25, 80, 5});
  DirectRefinement refinement(clear.model, 4);
  for (const RefinedPair* scene : {&faint, &clear, &faint, &clear}) {
    const PlaneVector start = scene->off(0.2, 0);
    const Expected<PlaneFit> fit =
        refinement.refine(scene->left, scene->right, {start, scene->rows}, test::groundLimits(), 0);
    const Expected<PlaneFit> alone = scene->refine(start);
    ASSERT_TRUE(fit && alone);
    EXPECT_EQ(fit->plane.g, alone->plane.g);
    EXPECT_EQ(fit->plane.covariance, alone->plane.covariance);
    EXPECT_GT(refinement.agreement(), 0.8);
  }
}

TEST(DirectRefinement, TakesFaintImagesOfOddSize) {
  RefinedPair scene;
  scene.rig.size = cv::Size(319, 239);
  scene.model = test::makeModel(scene.rig);
  scene.render({0.25, 80, 5}, {0.25, 80, 5});
  const Expected<PlaneFit> fit = scene.refine(scene.off(0.2, 0));
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_LT(scene.error(fit->plane.g), 0.4);
}

TEST(DirectRefinement, RefusesImagesTooSmallForABlock) {
  RefinedPair scene;
  scene.rig.size = cv::Size(20, 1);
  scene.model = test::makeModel(scene.rig);
  scene.render();
  const Expected<PlaneFit> fit = scene.refine(scene.truth);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().reason, Reason::kTooFewMatches);
}

TEST(DirectRefinement, ForgetsItsStartWhereMostBlocksAreNoise) {
  RefinedPair scene;
  scene.ground.line_offset = 1;
  scene.render({0.2, 90, 5}, {0.2, 90, 5});
  const Expected<PlaneFit> above = scene.refine(scene.off(0.4, 0)), below = scene.refine(scene.off(-0.4, 0));
  ASSERT_TRUE(above && below);
  EXPECT_LT((above->plane.g - below->plane.g).norm() * scene.rig.fb(), 0.22) << "of 0.8 px";
}

TEST(DirectRefinement, HasTooFewMatchesWithoutTexture) {
  RefinedPair scene;
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
  RefinedPair scene;
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
  RefinedPair scene;
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

TEST(Doubt, MakesAPlaneAsUncertainAsItIsFarFromTheOther) {
  GroundPlane plane = test::exactPlane(makePose(10, -4, 0), 0.01, 0.001), other = plane;
  const double own = plane.heightVariance();
  other.g = 1.5 * plane.g;
  ASSERT_FALSE(samePlane(plane, other));
  doubt(plane, other);
  // dh = h dg / g: half of 10 m; tilt is as certain as before.
  EXPECT_NEAR(plane.heightVariance(), own + 5.0 * 5.0, 1e-6);
  const Eigen::Vector3d n = plane.normal();
  EXPECT_NEAR(std::sqrt(pitchVariance(n, plane.normalCovariance())), 0.001, 1e-6);
  EXPECT_TRUE(samePlane(plane, other));
}

}  // namespace
}  // namespace uav_landing
