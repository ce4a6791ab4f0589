#include "bags/topic_advice.h"

#include <gtest/gtest.h>

namespace uav_landing {
namespace {

constexpr char kImage[] = "sensor_msgs/Image", kCompressed[] = "sensor_msgs/CompressedImage",
               kInfo[] = "sensor_msgs/CameraInfo";

TEST(TopicAdvice, NamesTheOptionForAnotherNamespace) {
  EXPECT_EQ(topicAdvice({{"/uav1/nose/left/camera_info", kInfo},
                         {"/uav1/nose/left/image_raw", kImage},
                         {"/uav1/nose/right/camera_info", kInfo},
                         {"/uav1/nose/right/image_raw", kImage}},
                        "a.bag"),
            "\nIts cameras have another namespace: --camera uav1/nose");
}

TEST(TopicAdvice, NamesTheCommandForOtherTopics) {
  EXPECT_EQ(
      topicAdvice({{"/camera/infra1/camera_info", kInfo},
                   {"/camera/infra1/image_rect_raw", kImage},
                   {"/camera/infra2/camera_info", kInfo},
                   {"/camera/infra2/image_rect_raw", kImage},
                   {"/camera/color/image_raw", kImage}},
                  "my flights/a.bag"),
      "\nThis makes a bag that can be read:\n  rosrun uav_landing convert_recording bag 'my flights/a.bag' "
      "--left /camera/infra1/image_rect_raw --right /camera/infra2/image_rect_raw "
      "--output 'my flights/a_stereo.bag'");
  EXPECT_EQ(topicAdvice({{"/stereo/left/image_raw/compressed", kCompressed},
                         {"/stereo/right/image_raw/compressed", kCompressed},
                         {"/stereo/left/camera_info", kInfo}},
                        "a.bag"),
            "\nThis makes a bag that can be read:\n  rosrun uav_landing convert_recording bag a.bag "
            "--left /stereo/left/image_raw/compressed --right /stereo/right/image_raw/compressed "
            "--right-calibration right.yaml --output a_stereo.bag");
}

TEST(TopicAdvice, LeavesATopicThatCannotBeGuessedToBeFilledIn) {
  EXPECT_EQ(topicAdvice({{"/a", kImage}, {"/b", kImage}, {"/c", kImage}}, "a.bag"),
            "\nThis makes a bag that can be read (fill in the topics of the images):\n  rosrun uav_landing "
            "convert_recording bag a.bag --left LEFT_TOPIC --right RIGHT_TOPIC --output a_stereo.bag");
}

TEST(TopicAdvice, TakesASingleImageTopicForBothPictures) {
  EXPECT_EQ(topicAdvice({{"/usb_cam/image_raw", kImage}}, "a.bag"),
            "\nIf /usb_cam/image_raw has the images of both cameras side by side, this makes a bag that can "
            "be read:\n  rosrun "
            "uav_landing convert_recording bag a.bag --side-by-side /usb_cam/image_raw --left-calibration "
            "left.yaml "
            "--right-calibration right.yaml --output a_stereo.bag");
}

TEST(TopicAdvice, SaysNothingWhereThereAreNoImages) {
  EXPECT_EQ(topicAdvice({{"/imu", "sensor_msgs/Imu"}}, "a"), "");
}

}  // namespace
}  // namespace uav_landing
