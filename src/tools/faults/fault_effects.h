#pragma once

#include "faults/faults.h"

// Effects of single faults on a pair (faults.cpp has their names).
namespace uav_landing {

/// Turns the right camera. w: rotation vector in its own optical axes, rad.
void turnCamera(cv::Mat& image, const CameraCalibration& camera, const Eigen::Vector3d& w);
/// Enlarges an image about its principal point.
void zoomCamera(cv::Mat& image, const CameraCalibration& camera, double factor);
void changeExposure(cv::Mat& image, double gain, double offset);
void blur(cv::Mat& image, double sigma);
/// Water on a lens: a rest of the image, a veil, and the sensor's noise.
void fogLens(cv::Mat& image, cv::RNG& random);
void smear(cv::Mat& image, int pixels);
void addNoise(cv::Mat& image, double sigma, cv::RNG& random);
/// Dark spots at fixed places.
void soil(cv::Mat& image, uint64_t seed);
/// Water drops at fixed places: blurred and displaced.
void wet(cv::Mat& image, uint64_t seed);
void glare(cv::Mat& image);
void band(cv::Mat& image, double phase);
/// Haze that grows with the distance of the ground.
void night(cv::Mat& image, uint64_t seed);

/// Gives every pixel that sees the ground another grey level, by paint(x, y, grey). x, y: on the ground in
/// the runway frame, m.
using GroundPaint = std::function<double(double x, double y, double grey)>;
void paintGround(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose,
                 const GroundPaint& paint);
/// Replaces the ground beyond near_x by the reflection of the sky in a mirror.
void mirrorSky(cv::Mat& image, const SimulatedCamera& camera, const CameraPose& pose, double near_x,
               double far_x);

}  // namespace uav_landing
