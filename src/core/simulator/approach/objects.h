#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "simulator/approach/pixel_filter.h"
#include "uav_landing/simulator/camera_rig.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// A box that stands on the ground with its sides along the axes of the runway frame. A pole is a thin one.
struct StandingObject {
  Eigen::Vector3f low, high;  ///< opposite corners, m
  float brightness = 0;       ///< grey level of the side that faces the aircraft
};

/// Objects at random places on both sides of the runway.
std::vector<StandingObject> placeObjects(const SimulatedObjectsParameters& objects, double runway_width,
                                         uint64_t seed);

/// A camera at its place in the runway frame.
struct PlacedCamera {
  const SimulatedCamera& camera;
  Eigen::Matrix3d rotation;  ///< from rectified camera axes to the runway frame
  Eigen::Vector3d centre;    ///< m
};

/// Draws the objects over a part of an image of the ground (32-bit float). filter: the one that the ground
/// was drawn with.
void drawObjects(const std::vector<StandingObject>& objects, const PlacedCamera& view,
                 const PixelFilter& filter, const cv::Rect& part, cv::Mat& image);

}  // namespace uav_landing
