#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "support/degree.h"
#include "support/random_texture.h"
#include "uav_landing/image/rectification.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {
namespace test {

/// Left camera in the world: x along the runway, y left, z up, ground z = 0. Metres, radians; pitch up, yaw
/// left and roll right side down are positive.
struct Pose {
  Eigen::Vector3d position{0, 0, 1};
  double yaw = 0, pitch = 0, roll = 0;

  Eigen::Matrix3d worldFromOptical() const;
  /// A direction of the world in the optical frame.
  Eigen::Vector3d seen(const Eigen::Vector3d& direction) const {
    return worldFromOptical().transpose() * direction;
  }
  /// Ground normal, down, in the optical frame.
  Eigen::Vector3d down() const { return seen(-Eigen::Vector3d::UnitZ()); }
  double height() const { return position.z(); }
};

/// Over the origin, angles in degrees.
inline Pose makePose(double height, double pitch_deg, double roll_deg) {
  Pose pose;
  pose.position = {0, 0, height};
  pose.pitch = pitch_deg * kDegree;
  pose.roll = roll_deg * kDegree;
  return pose;
}

/// Movement from a pose to a later one, worked out from the poses: x_now = R x_then - t.
struct Movement {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;  ///< in the frame now, metres
  double angle;       ///< of the path below the horizontal
  Movement(const Pose& then, const Pose& now);
};

/// A box that stands on the ground.
struct Box {
  Eigen::Vector3d low, high;
};

/// What one camera makes of the light: grey = gain light + offset + noise, rounded to 8 bits.
struct Exposure {
  double gain = 1, offset = 0, noise = 1;
};

/// Textured plane with paint and boxes on it, drawn by cutting each pixel's ray with it. The texture has
/// detail at all scales from grain upwards; what is finer than a pixel sees at its distance is left out,
/// which is the same for both cameras of a rig, as they see a point at the same depth.
class GroundRenderer {
 public:
  explicit GroundRenderer(unsigned seed) : texture_(seed), seed_(seed) {}

  double grain = 0.01;                             ///< m, finest lattice spacing
  double contrast = 14;                            ///< grey levels, 1 sigma of each scale
  double line_offset = 0;                          ///< m, two painted lines along x at y = +- this; 0: none
  double line_width = 0.1;                         ///< m
  double bar_period = 0;                           ///< m, zebra: bars along x repeated over y; 0: none
  double bar_from = 0, bar_to = 0, bar_reach = 0;  ///< m, where along x, and |y| up to
  std::vector<Box> boxes;
  Eigen::Vector3d bend{0, 0, 0};  ///< rotation vector of the right camera against the rig, rad

  cv::Mat left(const StereoRig& rig, const Pose& pose, const Exposure& exposure = {}) const {
    return draw(rig, rig.cx, pose, 0, Eigen::Vector3d::Zero(), exposure);
  }
  cv::Mat right(const StereoRig& rig, const Pose& pose, const Exposure& exposure = {}) const {
    return draw(rig, rig.cx_right, pose, rig.baseline, bend, exposure);
  }

 private:
  cv::Mat draw(const StereoRig& rig, double cx, const Pose& pose, double offset, const Eigen::Vector3d& turn,
               const Exposure& exposure) const;
  double groundLight(double x, double y, double depth, double f, double height) const;
  double paint(double x, double y, double across, double along) const;
  bool boxLight(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, double f, double* depth,
                double* light) const;
  double textured(double x, double y, double resolution) const;

  RandomTexture texture_;
  unsigned seed_;
};

/// 60 degrees wide, principal point off the centre and different left and right.
StereoRig makeRig(int width, int height, double baseline);
/// The rig with images that have picture everywhere.
RigModel makeModel(const StereoRig& rig);
/// What stereo would say of a pose, exactly, with the given 1 sigma of height (share) and normal (rad).
GroundPlane exactPlane(const Pose& pose, double height_share, double normal_stddev);

}  // namespace test
}  // namespace uav_landing
