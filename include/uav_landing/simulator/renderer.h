#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/ground_profile.h"
#include "uav_landing/simulator/objects.h"
#include "uav_landing/simulator/scene.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// Draws what a camera sees: each sample's ray is cut with the ground exactly (its tangent, where it is
/// curved), and the ground is averaged over the patch that the sample covers.
class Renderer {
 public:
  /// supersampling: samples along each side of a pixel.
  Renderer(Scene scene, std::vector<StandingObject> objects, int supersampling,
           GroundProfile profile = GroundProfile());

  /// Grey levels as 32-bit floats, of the camera's size. pose: of the rectified left camera, also for the
  /// right.
  void render(const SimulatedCamera& camera, const CameraPose& pose, cv::Mat& image) const;

 private:
  struct View;
  struct Sample;
  struct OnGround;
  OnGround onGround(const View& view, const Sample& sample) const;
  float pixel(const View& view, const PixelRay& ray) const;
  float mixed(const View& view, const PixelRay& ray) const;
  float ground(const View& view, const OnGround& ground) const;
  float sky(const Sample& sample) const;

  Scene scene_;
  std::vector<StandingObject> objects_;
  int supersampling_;
  GroundProfile profile_;
};

}  // namespace uav_landing
