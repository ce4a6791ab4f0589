#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "uav_landing/geometry/calibration.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

/// Where the left camera is over a runway. Runway frame: x along the landing direction from the threshold, y
/// left, z up from the plane of the surface; m. Angles are those of LandingResult, against that plane; rad.
struct RunwayPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double roll = 0, pitch = 0, yaw = 0;

  Eigen::Matrix3d cameraFromRunway() const;
  /// A point of the runway frame in the camera's.
  Eigen::Vector3d seen(const Eigen::Vector3d& point) const { return cameraFromRunway() * (point - position); }
};

/// The plane of the surface, without a covariance.
GroundPlane planeOf(const RunwayPose& pose);

/// Of the runway's surface, m.
struct RunwaySize {
  double width = 0, length = 0;
};

/// What the outline's image is expected to be like.
struct OutlineLook {
  double focal_length = 0;  ///< px
  /// Of the surface, about, m: what markings are small against. Length 0: by the taper.
  RunwaySize size{35, 0};
  double blur = 0.65;  ///< 1 sigma of the image's blur, pixels included, px
  double blur_stddev = 0.12;
};

/// Corners of the surface in the image: near left, far left, far right, near right; px. The sides lead from
/// one to the next: left, far, right, near.
using Corners = std::array<Eigen::Vector2d, 4>;
constexpr int kSides = 4;
constexpr int kLeftSide = 0, kFarSide = 1, kRightSide = 2, kNearSide = 3;

/// A side of the outline. Its place is told by how far it is moved into the surface at both ends of a
/// reference, px.
struct OutlineSide {
  Eigen::Vector2d from, along, inward;  ///< first end; unit vectors
  double length = 0;                    ///< px

  /// Of the reference.
  OutlineSide(const Corners& corners, int side);
  /// Of a line through two points: moved inward at the ends.
  Eigen::Vector2d movedTo(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
};

/// The image of the surface's corners; none unless all are in front of the camera.
std::optional<Corners> cornersOf(const RunwayPose& pose, const RunwaySize& size, const StereoRig& rig);

/// The upright rectangle around all corners.
Eigen::AlignedBox2d boxOf(const Corners& corners);

/// Width between the long sides of an outline in a row of the image, px.
double widthInRow(const Corners& corners, double row);

/// How far each side of the corners lies inside of the reference's, at both ends of that, side by side.
Vector8d movedInward(const Corners& reference, const Corners& corners);
/// Corners whose sides are moved inward by this.
Corners movedBy(const Corners& reference, const Vector8d& inward);

}  // namespace uav_landing
