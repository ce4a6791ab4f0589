#include "rig_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace uav_landing;

namespace {

tf2_msgs::TFMessage transform(const std::string& parent, const std::string& child, double x) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.translation.x = x;
  message.transforms[0].transform.rotation.w = 1;
  return message;
}

TEST(RigFrames, WithoutTfTheRectifiedLeftCameraIsEstimated) {
  const RigFrames frames("", "runway");
  const RigFrames::Child child = frames.find("left");
  EXPECT_EQ(child.frame, "left_rect");
  EXPECT_FALSE(child.left_from_child);
  EXPECT_TRUE(child.may_broadcast);
  EXPECT_FALSE(child.failure);
}

TEST(RigFrames, BaseLinkOfTheStaticTfIsEstimated) {
  RigFrames frames("", "runway");
  frames.add(transform("base_link", "mount", 1), true);
  frames.add(transform("mount", "left", 0.5), true);
  const RigFrames::Child child = frames.find("left");
  EXPECT_EQ(child.frame, "base_link");
  ASSERT_TRUE(child.left_from_child);
  EXPECT_NEAR(child.left_from_child->translation().x(), -1.5, 1e-12) << "base_link is behind the camera";
  EXPECT_TRUE(child.may_broadcast);
}

TEST(RigFrames, TheLeftCameraItselfMayBeConfiguredWithoutTf) {
  const RigFrames frames("left", "runway");
  const RigFrames::Child child = frames.find("/left");
  EXPECT_FALSE(child.failure) << child.failure.message();
  EXPECT_EQ(child.frame, "left");
  ASSERT_TRUE(child.left_from_child);
  EXPECT_TRUE(child.left_from_child->isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(child.may_broadcast);
}

TEST(RigFrames, ALeadingSlashMakesNoDifference) {
  RigFrames frames("/base_link", "/runway");
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_EQ(frames.find("/left").frame, "base_link");
}

TEST(RigFrames, LeverArmsThatMoveAreNotTaken) {
  RigFrames frames("", "runway");
  frames.add(transform("base_link", "left", 1), false);
  EXPECT_EQ(frames.find("left").frame, "left_rect");
}

TEST(RigFrames, BaseLinkWithAParentIsLeftAlone) {
  RigFrames frames("", "runway");
  frames.add(transform("base_link", "left", 1), true);
  frames.add(transform("odom", "base_link", 0), false);
  EXPECT_EQ(frames.find("left").frame, "left_rect");
}

TEST(RigFrames, AConfiguredFrameWithAParentIsEstimatedButNotBroadcast) {
  RigFrames frames("base_link", "runway");
  frames.add(transform("base_link", "left", 1), true);
  frames.add(transform("odom", "base_link", 0), false);
  EXPECT_EQ(frames.find("left").frame, "base_link");
  EXPECT_FALSE(frames.find("left").may_broadcast);
}

TEST(RigFrames, OurOwnTransformIsNotAnotherParent) {
  RigFrames frames("", "runway");
  frames.add(transform("base_link", "left", 1), true);
  frames.add(transform("runway", "base_link", 0), false);
  EXPECT_EQ(frames.find("left").frame, "base_link");
  EXPECT_TRUE(frames.find("left").may_broadcast);
}

TEST(RigFrames, TransformsThatAreNoneAreLeftOut) {
  RigFrames frames("base_link", "runway");
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    frames.add(transform("base_link", "left", bad), true);
    EXPECT_TRUE(frames.find("left").failure) << bad;
  }
  tf2_msgs::TFMessage no_rotation = transform("base_link", "left", 1);
  no_rotation.transforms[0].transform.rotation.w = 0;
  frames.add(no_rotation, true);
  EXPECT_TRUE(frames.find("left").failure);
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_FALSE(frames.find("left").failure);
}

TEST(RigFrames, AQuaternionThatIsNotQuiteOfUnitLengthIsARotationAllTheSame) {
  RigFrames frames("base_link", "runway");
  tf2_msgs::TFMessage message = transform("base_link", "left", 0);
  message.transforms[0].transform.rotation.w = 1.0008 * std::cos(0.2);
  message.transforms[0].transform.rotation.z = 1.0008 * std::sin(0.2);
  frames.add(message, true);
  ASSERT_TRUE(frames.find("left").left_from_child);
  const Eigen::Matrix3d R = frames.find("left").left_from_child->linear();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(RigFrames, ALoopIsNoTransform) {
  RigFrames frames("base_link", "runway");
  frames.add(transform("arm", "mount", 1), true);
  frames.add(transform("mount", "left", 1), true);
  frames.add(transform("left", "arm", 1), true);
  frames.add(transform("base_link", "nose", 1), true);
  frames.add(transform("left", "left", 1), true);
  EXPECT_TRUE(frames.find("left").failure);
}

TEST(RigFrames, NamesThatNeverEndAreNotKept) {
  RigFrames frames("base_link", "runway");
  for (int i = 0; i < 20000; ++i) frames.add(transform("parent" + std::to_string(i), "child", 1), true);
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_TRUE(frames.find("left").failure) << "ten thousand names are enough";
}

TEST(RigFrames, AConfiguredFrameThatIsUnknownIsAFailure) {
  RigFrames frames("imu", "runway");
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_EQ(frames.find("left").failure.message(),
            "transform_missing: no static transform between imu and left");
}

}  // namespace
