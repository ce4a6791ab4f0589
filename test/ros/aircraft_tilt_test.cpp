#include "aircraft_tilt.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace uav_landing;

namespace {

constexpr double kDegree = M_PI / 180;

/// Axes of a camera's frame, as columns of right, down and forward as the camera sees them.
Eigen::Matrix3d axes(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d camera_from_frame;
  camera_from_frame << x, y, z;
  return camera_from_frame;
}

const Eigen::Vector3d kRight(1, 0, 0), kDown(0, 1, 0), kForward(0, 0, 1);
const Eigen::Matrix3d kOptical = axes(kRight, kDown, kForward);
const Eigen::Matrix3d kForwardLeftUp = axes(kForward, -kRight, -kDown);
const Eigen::Matrix3d kForwardRightDown = axes(kForward, kRight, kDown);
const Eigen::Matrix3d kRightForwardUp = axes(kRight, kForward, -kDown);    // as east, north, up
const Eigen::Matrix3d kRightUpBackward = axes(kRight, -kDown, -kForward);  // OpenGL's

/// A camera that looks down by this angle on a level aircraft. Its tf is right for a frame with the given
/// axes, but the rig takes that frame for an optical one.
Eigen::Matrix3d takenFor(const Eigen::Matrix3d& camera_frame, const Eigen::Matrix3d& aircraft_frame,
                         double down) {
  const Eigen::Matrix3d camera_from_level(Eigen::AngleAxisd(down, Eigen::Vector3d::UnitX()));
  return camera_frame.transpose() * camera_from_level * aircraft_frame;
}

RigFrames::Child child(const std::string& name) {
  RigFrames::Child child;
  child.frame = name;
  child.left_from_child = Eigen::Isometry3d::Identity();
  return child;
}

LandingResult cameraWith(double pitch, double roll) {
  LandingResult camera;
  camera.pitch = pitch;
  camera.roll = roll;
  camera.height_valid = camera.angle_valid = true;
  return camera;
}

std::string reasonOf(const Eigen::Matrix3d& rectified_from_child, const LandingResult& camera,
                     const RigFrames::Child& frame = child("base_link")) {
  return wrongTilt(frame, rectified_from_child, camera, "left").message();
}

TEST(AircraftTilt, OpticalFramesAreRightHoweverTheCameraIsMounted) {
  for (int down = -45; down <= 45; down += 5)
    for (int roll = -30; roll <= 30; roll += 10)
      EXPECT_EQ(reasonOf(takenFor(kOptical, kForwardLeftUp, down * kDegree),
                         cameraWith(-down * kDegree, roll * kDegree)),
                "")
          << down << ' ' << roll;
}

TEST(AircraftTilt, ABodyFrameOfTheCameraIsNone) {
  EXPECT_EQ(
      reasonOf(takenFor(kForwardLeftUp, kForwardLeftUp, 0), cameraWith(-5 * kDegree, 0)),
      "transform_invalid: base_link is tilted by 95 deg: the frame_id of camera_info must be an optical "
      "frame (z forward, x right, y down), in static tf left is not");
  EXPECT_EQ(
      reasonOf(takenFor(kForwardRightDown, kForwardLeftUp, 0), cameraWith(-5 * kDegree, 0)),
      "transform_invalid: base_link is tilted by 85 deg: the frame_id of camera_info must be an optical "
      "frame (z forward, x right, y down), in static tf left is not");
  EXPECT_EQ(
      reasonOf(takenFor(kRightUpBackward, kForwardLeftUp, 0), cameraWith(-5 * kDegree, 0)),
      "transform_invalid: base_link is tilted by 175 deg: the frame_id of camera_info must be an optical "
      "frame (z forward, x right, y down), in static tf left is not");
}

TEST(AircraftTilt, AnAircraftFrameThatLooksDownIsNone) {
  EXPECT_EQ(
      reasonOf(takenFor(kOptical, kForwardRightDown, 0), cameraWith(-5 * kDegree, 0), child("base_link_frd")),
      "transform_invalid: base_link_frd is tilted by 175 deg: its z axis must be up (x forward, y left), "
      "and the frame_id of camera_info an optical frame (z forward, x right, y down)");
}

TEST(AircraftTilt, EveryOtherFrameIsFoundHoweverTheCameraLooks) {
  for (const Eigen::Matrix3d& aircraft : {kForwardLeftUp, kForwardRightDown}) {
    for (const Eigen::Matrix3d& camera :
         {kForwardLeftUp, kForwardRightDown, kRightForwardUp, kRightUpBackward}) {
      // Both wrong by half a turn about the same axis is right for the up axis, which is what is tested.
      if (camera == kRightUpBackward && aircraft == kForwardRightDown) continue;
      for (int down = -45; down <= 45; down += 5) {
        const Eigen::Matrix3d rotation = takenFor(camera, aircraft, down * kDegree);
        // The tf of axes like east, north, up shows less the farther the camera looks down.
        if (camera != kRightForwardUp || std::abs(down) <= 25)
          EXPECT_NE(reasonOf(rotation, LandingResult()), "") << "without an attitude " << down;
        EXPECT_NE(reasonOf(rotation, cameraWith(-down * kDegree, 0)), "") << down;
      }
    }
  }
  EXPECT_EQ(reasonOf(takenFor(kForwardLeftUp, kForwardLeftUp, 0), LandingResult()).substr(0, 49),
            "transform_invalid: base_link is tilted by 90 deg:");
}

TEST(AircraftTilt, NoAircraftLandsWithSuchAnAttitude) {
  const Eigen::Matrix3d mounting = takenFor(kOptical, kForwardLeftUp, 30 * kDegree);
  // The camera looks 30 degrees down on an aircraft whose nose is 40 degrees down then.
  EXPECT_EQ(reasonOf(mounting, cameraWith(-70 * kDegree, 0)), "");
  EXPECT_EQ(reasonOf(mounting, cameraWith(35 * kDegree, 0)),
            "transform_invalid: base_link is tilted by 65 deg: its static tf is wrong, or the attitude is");
  LandingResult lost = cameraWith(35 * kDegree, 0);
  lost.height_valid = lost.angle_valid = false;
  EXPECT_EQ(reasonOf(mounting, lost), "") << "it has a reason of its own";
}

TEST(AircraftTilt, ACameraThatIsEstimatedItselfIsNoAircraft) {
  RigFrames::Child camera = child("left");
  camera.is_left_camera = true;
  EXPECT_EQ(reasonOf(Eigen::Matrix3d::Identity(), cameraWith(0, 0), camera), "");
  EXPECT_EQ(reasonOf(Eigen::Matrix3d::Identity(), cameraWith(0, 0), RigFrames::Child()), "");
}

TEST(AircraftTilt, IsTheAngleInWholeDegrees) {
  EXPECT_EQ(tiltInDegrees(0.5), 60);
  EXPECT_EQ(tiltInDegrees(-1 - 1e-15), 180) << "of a rotation that is none in the last digit";
}

}  // namespace
