#pragma once

#include <functional>

#include "faults/flight.h"

// Effects of where the cameras look, and of the ground that they see.
namespace uav_landing {

/// Turns the right camera. w: rotation vector in its own optical axes, rad.
void turnCamera(cv::Mat& image, const CameraCalibration& camera, const Eigen::Vector3d& w);
/// Enlarges an image about its principal point.
void zoomCamera(cv::Mat& image, const CameraCalibration& camera, double factor);
/// Moves the image, as a lens does that was hit. by: px.
void displace(cv::Mat& image, const Eigen::Vector2d& by);

/// Gives every pixel that sees the ground another grey level, by paint(x, y, grey). x, y: on the ground in
/// the runway frame, m.
using GroundPaint = std::function<double(double x, double y, double grey)>;
void paintGround(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
                 const GroundPaint& paint);
/// Share of the light from a place on the ground that is the reflection of the sky, 0 to 1.
using MirrorShare = std::function<double(double x, double y)>;
/// Lets the ground reflect the sky as a perfectly flat mirror does.
void mirrorSky(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
               const MirrorShare& share);

}  // namespace uav_landing
