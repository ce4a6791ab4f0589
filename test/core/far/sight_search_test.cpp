#include "far/sight_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runway_picture.h"

namespace uav_landing {
namespace {

constexpr double kDegree = M_PI / 180;

class SightSearchTest : public testing::Test {
 protected:
  SightSearchTest() {
    model_.rig = picture_.rig();
    model_.left_mask = cv::Mat(picture_.size, CV_8U, cv::Scalar(255));
    runway_.width = picture_.width;
    runway_.length = picture_.length;
    pose_ = {{-2200, 8, 120}, 0, -3 * kDegree, 0};
  }

  SightFit fit() const { return {model_, ApproachAngleParameters(), runway_}; }
  /// Steps over pictures of these poses, one after the other, until the search ends.
  template <class PoseOf>
  Expected<SightedRunway> run(SightSearch& search, const PoseOf& poseOf, int most) {
    for (steps_ = 1; steps_ <= most; ++steps_) {
      pose_ = poseOf(steps_);
      const cv::Mat picture = picture_.render(pose_, steps_);
      search.follow(picture);
      const auto found = search.step(fit(), picture, ground_);
      if (found) return *found;
    }
    return tl::make_unexpected(Failure{Reason::kNotYet, "it does not end"});
  }

  /// Ground that stereo knows so many standard deviations below the runway. One is 1 % of the distance of
  /// 2200 m; the fit's own is small beside it.
  void groundBelow(double sigmas) {
    ground_.plane.g = normalFromPitchRoll(pose_.pitch, pose_.roll) /
                      (pose_.position.z() + sigmas * 0.01 * -pose_.position.x());
    ground_.plane.covariance = 1e-16 * Eigen::Matrix3d::Identity();
  }

  RunwayPicture picture_;
  RigModel model_;
  RunwayParameters runway_;
  RunwayPose pose_;
  KnownGround ground_;
  int steps_ = 0;
};

TEST_F(SightSearchTest, FindsTheOutlineWhereItHasMovedTo) {
  SightSearch search;
  const RunwayPose first = pose_;
  ASSERT_FALSE(search.begin(fit(), picture_.render(first), {}));
  const auto turning = [&](int step) {
    RunwayPose pose = first;
    pose.pitch += step * kDegree;  // 10 px a picture
    return pose;
  };
  const Expected<SightedRunway> found = run(search, turning, 16);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_FALSE(search.running());
  EXPECT_GE(steps_, 2) << "a start at the near end that shows, and one farther away";
  const Corners expected = *cornersOf(pose_, {picture_.width, picture_.length}, model_.rig);
  for (int i = 0; i < 4; ++i) EXPECT_LT((found->corners[i] - expected[i]).norm(), 2.5) << i;
}

TEST_F(SightSearchTest, BeginsWithAnOutlineOnTheGroundOnly) {
  const auto at_rest = [&](int) { return pose_; };
  for (const double off : {1.0, 2.5}) {
    SightSearch search;
    ground_ = {};
    ASSERT_FALSE(search.begin(fit(), picture_.render(pose_), ground_));
    groundBelow(off);
    const Expected<SightedRunway> found = run(search, at_rest, 16);
    if (off < 2) {
      ASSERT_TRUE(found) << found.error().message();
      EXPECT_NEAR(std::abs(offPlane(found->pose, ground_.plane)), off, 0.4);
      // What is followed may be a little farther off.
      groundBelow(2.5);
      EXPECT_FALSE(fit().problemOf(found->pose, ground_));
    } else {
      ASSERT_FALSE(found);
      EXPECT_EQ(found.error().detail, "an outline too far off the ground's plane to begin with");
    }
  }
}

TEST_F(SightSearchTest, BareGroundHasNoCandidates) {
  picture_.surface = picture_.paint = picture_.ground;
  SightSearch search;
  EXPECT_EQ(search.begin(fit(), picture_.render(pose_), {}).reason, Reason::kNoRunway);
  EXPECT_FALSE(search.running());
}

TEST_F(SightSearchTest, TwoRunwaysThatShowAlikeLeaveItOpen) {
  const cv::Mat one = picture_.render(pose_);
  cv::Mat two = one.clone();
  one.colRange(290, 350).copyTo(two.colRange(370, 430));  // the runway once more, farther to the right
  // Also where both lie too far off the ground to begin with.
  for (const double off : {0.0, 2.5}) {
    groundBelow(off);
    SightSearch search;
    ASSERT_FALSE(search.begin(fit(), two, {}));
    std::optional<Expected<SightedRunway>> found;
    for (int i = 0; i < 24 && !found; ++i) found = search.step(fit(), two, ground_);
    ASSERT_TRUE(found.has_value());
    ASSERT_FALSE(*found);
    EXPECT_EQ(found->error().detail, "more than one outline may be the runway's") << off;
  }
}

}  // namespace
}  // namespace uav_landing
