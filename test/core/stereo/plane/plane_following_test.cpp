#include "stereo/plane/plane_following.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "image/windows/match_image.h"
#include "stereo/matching/corner_matching.h"
#include "support/ground_renderer.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing {
namespace {

using test::GroundRenderer;
using test::kDegree;
using test::makePose;
using test::Pose;

/// A pair of one rig at full size and reduced, and the corners of the plane that was there before.
struct Tracking {
  StereoRig rig = test::makeRig(640, 480, 1.0);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground{17};
  StereoDepthParameters parameters;
  PlaneLimits limits{30 * kDegree, 30 * kDegree, 20, 0.6};
  MatchImage left_images, right_images;
  StereoLevel fine, coarse;
  std::vector<cv::Point> corners;
  PlaneVector before;

  Tracking(const Pose& last, const Pose& now, double noise_share = 0) : before(last.down() / last.height()) {
    ground.grain = 0.05;
    cv::Mat left = ground.left(rig, now), right = ground.right(rig, now);
    // The other image does not have what is seen in the left part of one.
    if (noise_share > 0) {
      cv::Mat part = right.colRange(0, static_cast<int>(noise_share * right.cols));
      cv::randu(part, 0, 255);
    }
    left_images.assign(left, {});
    right_images.assign(right, {});
    fine = {rig, model.left_mask, model.right_mask, left_images.fine, right_images.fine};
    coarse = reduceLevel(model, left_images.factor, 7);
    coarse.left = left_images.coarse;
    coarse.right = right_images.coarse;
    corners = findGroundCorners(fine, before, parameters.corner_count, parameters);
  }
  std::optional<Consensus> byScouts() const {
    return trackPlaneByScouts(coarse, {corners, left_images.factor}, before, parameters, limits);
  }
  std::optional<Consensus> byAll() const {
    GroundCornerMemory memory;
    return trackPlane(coarse, before, parameters, limits, memory);
  }
  /// Largest error of the disparity over the lowest row of the image, pixels at full size.
  double error(const Consensus& found, const Pose& now) const {
    const Eigen::Vector3d difference = found.g.vector() - now.down() / now.height();
    const double bottom = rig.size.height - 1, right = rig.size.width - 1;
    return rig.fb() * std::max(std::abs(difference.dot(rig.ray(0, bottom))),
                               std::abs(difference.dot(rig.ray(right, bottom))));
  }
};

constexpr double kUseful = 1;  // px: the search at full size reaches twice as far

TEST(TrackPlaneByScouts, FollowsHeightPitchAndRoll) {
  const Pose last = makePose(12, -4, 1);
  for (const Pose& now : {makePose(11.6, -4, 1), makePose(12, -4.6, 1), makePose(12, -3.4, 1),
                          makePose(12.3, -4, 3), makePose(11.8, -4.3, -1)}) {
    const Tracking tracking(last, now);
    const std::optional<Consensus> found = tracking.byScouts();
    ASSERT_TRUE(found);
    EXPECT_LT(tracking.error(*found, now), kUseful);
  }
}

TEST(TrackPlaneByScouts, LeavesItToAllCornersWhereLessThanHalfOfThePictureAgrees) {
  const Pose last = makePose(12, -4, 1), now = makePose(11.8, -4, 1);
  const Tracking tracking(last, now, 0.48);
  EXPECT_FALSE(tracking.byScouts());
  const std::optional<Consensus> found = tracking.byAll();
  ASSERT_TRUE(found);
  EXPECT_LT(tracking.error(*found, now), kUseful);
}

TEST(TrackPlaneByScouts, FindsNothingWhereThePlaneJumpsOutOfReach) {
  const Pose last = makePose(12, -4, 0);
  for (const Pose& now : {makePose(5, -4, 0), makePose(4, -8, 0), makePose(50, -4, 0)})
    EXPECT_FALSE(Tracking(last, now).byScouts());
}

TEST(CornersOnGround, AreThoseThatAPlaneGivesADisparityInTheRightImage) {
  const Pose last = makePose(12, -4, 0);
  const Tracking tracking(last, last);
  // With the nose up the horizon is lower in the picture.
  const Pose up = makePose(12, -1, 0);
  const PlaneVector g(up.down() / up.height());
  const std::vector<cv::Point> kept = cornersOnGround(tracking.fine, tracking.corners, g);
  EXPECT_LT(kept.size(), tracking.corners.size());
  EXPECT_GT(kept.size(), tracking.corners.size() / 2);
  for (const cv::Point& corner : kept) {
    const double disparity = g.disparity(tracking.rig, corner.x, corner.y);
    EXPECT_GE(disparity, 0.3);
    EXPECT_GE(corner.x - disparity - tracking.rig.principalOffset(), 0);
  }
  EXPECT_EQ(cornersOnGround(tracking.fine, tracking.corners, tracking.before), tracking.corners);
}

}  // namespace
}  // namespace uav_landing
