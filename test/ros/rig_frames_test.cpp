#include "rig_frames.h"

#include <gtest/gtest.h>

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

TEST(RigFrames, AConfiguredFrameThatIsUnknownIsAFailure) {
  RigFrames frames("imu", "runway");
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_EQ(frames.find("left").failure.message(),
            "transform_missing: no static transform between imu and left");
}

}  // namespace
