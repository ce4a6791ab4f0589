#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "simulator/approach/lights.h"
#include "simulator/approach/objects.h"
#include "simulator/approach/pixel_filter.h"
#include "simulator/ground/ground_profile.h"
#include "simulator/ground/scene.h"
#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// Draws what a camera sees. Each sample's ray is intersected with the ground exactly; where the ground is
/// curved, with its tangent. The grey level is the mean over the patch of ground that the sample covers.
class Renderer {
 public:
  /// image: its supersampling and blur are used.
  Renderer(Scene scene, std::vector<StandingObject> objects, const SimulatedImageParameters& image,
           GroundProfile profile = GroundProfile(), RunwayLights lights = {});

  /// Writes grey levels as 32-bit floats, in the camera's size. pose: that of the rectified left camera, also
  /// for the right camera.
  void render(const SimulatedCamera& camera, const CameraPose& pose, cv::Mat& image) const;
  /// The same for one part of an existing image.
  void render(const SimulatedCamera& camera, const CameraPose& pose, const cv::Rect& part,
              cv::Mat& image) const;
  /// 1 sigma of the lens's blur that remains to be applied, px.
  double blurLeft() const { return filter_.blurLeft(); }

 private:
  struct View;
  struct Sample;
  struct OnGround;
  OnGround onGround(const View& view, const Sample& sample) const;
  float pixel(const View& view, const PixelRay& ray) const;
  float mixed(const View& view, const PixelRay& ray) const;
  float ground(const View& view, const OnGround& ground) const;
  /// share: part of the sample's sides that counts.
  float sky(const Sample& sample, float share = 1) const;

  Scene scene_;
  std::vector<StandingObject> objects_;
  PixelFilter filter_;
  GroundProfile profile_;
  RunwayLights lights_;
};

}  // namespace uav_landing
