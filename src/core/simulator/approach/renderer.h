#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "simulator/approach/objects.h"
#include "simulator/approach/pixel_filter.h"
#include "simulator/ground/ground_profile.h"
#include "simulator/ground/scene.h"
#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// Draws what a camera sees: each sample's ray is cut with the ground exactly (its tangent, where it is
/// curved), and the ground is averaged over the patch that the sample covers.
class Renderer {
 public:
  /// image: its supersampling and blur count.
  Renderer(Scene scene, std::vector<StandingObject> objects, const SimulatedImageParameters& image,
           GroundProfile profile = GroundProfile());

  /// Grey levels as 32-bit floats, of the camera's size. pose: of the rectified left camera, also for the
  /// right.
  void render(const SimulatedCamera& camera, const CameraPose& pose, cv::Mat& image) const;
  /// The same for one part of a picture that is there already.
  void render(const SimulatedCamera& camera, const CameraPose& pose, const cv::Rect& part,
              cv::Mat& image) const;
  /// 1 sigma of the lens's blur that is still to be done, px.
  double blurLeft() const { return filter_.blurLeft(); }

 private:
  struct View;
  struct Sample;
  struct OnGround;
  OnGround onGround(const View& view, const Sample& sample) const;
  float pixel(const View& view, const PixelRay& ray) const;
  float mixed(const View& view, const PixelRay& ray) const;
  float ground(const View& view, const OnGround& ground) const;
  /// share: of the sample's sides that counts.
  float sky(const Sample& sample, float share = 1) const;

  Scene scene_;
  std::vector<StandingObject> objects_;
  PixelFilter filter_;
  GroundProfile profile_;
};

}  // namespace uav_landing
