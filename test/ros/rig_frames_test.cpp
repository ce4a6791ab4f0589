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

TEST(RigFrames, ATransformOnTfInsteadOfTfStaticIsNamed) {
  RigFrames configured("base_link", "runway"), automatic("", "runway");
  for (RigFrames* frames : {&configured, &automatic}) {
    frames->add(transform("base_link", "mount", 1), false);
    frames->add(transform("mount", "left", 1), true);
  }
  EXPECT_EQ(configured.find("left").failure.message(),
            "transform_missing: base_link -> mount is on /tf, only /tf_static is used for the rig");
  EXPECT_FALSE(automatic.find("left").failure);
  EXPECT_EQ(
      automatic.find("left").complaint,
      "base_link -> mount is on /tf, only /tf_static is used for the rig: the left camera is estimated");
  for (RigFrames* frames : {&configured, &automatic}) {
    frames->add(transform("base_link", "mount", 1), true);
    frames->add(transform("base_link", "mount", 1), false);
    EXPECT_EQ(frames->find("left").frame, "base_link") << "on both is on /tf_static";
    EXPECT_EQ(frames->find("left").complaint, "");
  }
}

TEST(RigFrames, ATransformOnTfIsNamedFromEitherEnd) {
  RigFrames frames("nose", "runway");
  frames.add(transform("body", "left", 1), true);
  frames.add(transform("body", "nose", 1), false);
  frames.add(transform("odom", "body", 1), false);
  EXPECT_EQ(frames.find("left").failure.detail,
            "body -> nose is on /tf, only /tf_static is used for the rig");
  EXPECT_EQ(frames.whyNotConnected("left", "elsewhere", "unknown").message(), "transform_missing: unknown");
}

TEST(RigFrames, FramesThatOnlyShareALoopOnTfAreNotConnected) {
  RigFrames frames("base_link", "runway");
  frames.add(transform("arm", "left", 1), false);
  frames.add(transform("left", "arm", 1), false);
  EXPECT_EQ(frames.find("left").failure.detail, "no static transform between base_link and left");
}

TEST(RigFrames, BaseLinkWithAParentIsNotMissedOnTfEither) {
  RigFrames frames("", "runway");
  frames.add(transform("odom", "base_link", 1), false);
  frames.add(transform("base_link", "left", 1), false);
  EXPECT_EQ(frames.find("left").complaint, "") << "it would be left alone all the same";
}

TEST(RigFrames, ACameraWithoutAFrameIdHasNoFrame) {
  const RigFrames automatic("", "runway"), configured("base_link", "runway");
  for (const char* name : {"", "/"}) {
    const RigFrames::Child child = automatic.find(name);
    EXPECT_EQ(child.frame, "");
    EXPECT_FALSE(child.may_broadcast);
    EXPECT_FALSE(child.failure);
    EXPECT_EQ(child.complaint, "the frame_id of the left camera_info is empty: the left camera is estimated");
    EXPECT_EQ(configured.find(name).failure.message(),
              "transform_missing: the frame_id of the left camera_info is empty");
  }
}

TEST(RigFrames, OnlyAFrameOfTheRigsOwnIsAnAircraft) {
  RigFrames frames("", "runway");
  EXPECT_FALSE(frames.find("left").isAircraft());
  EXPECT_TRUE(frames.find("base_link").isAircraft()) << "a camera that calls itself so";
  frames.add(transform("base_link", "left", 1), true);
  EXPECT_TRUE(frames.find("left").isAircraft());
  EXPECT_FALSE(RigFrames("left", "runway").find("left").isAircraft());
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
