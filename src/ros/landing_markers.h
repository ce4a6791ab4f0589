#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "node_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Pose of the left camera in the runway frame, for drawing.
struct DrawnAircraft {
  Eigen::Vector3d position;            ///< m
  Eigen::Vector3d stddev;              ///< of position, m
  Eigen::Matrix3d runway_from_camera;  ///< rectified left camera, optical axes
};

/// Everything that rviz shows besides the images.
struct LandingScene {
  visualization_msgs::MarkerArray markers;
  /// Transform from the runway frame to landing_view, the frame of the view in rviz/landing.rviz. It is level
  /// and lies behind, right of and above the aircraft. Its distance is a number of heights, so that near and
  /// far look the same.
  geometry_msgs::TransformStamped view;
};

/// Draws the scene: outline and centre line of the runway, path flown, aircraft, ellipsoid, path ahead, and
/// the numbers as text. The ellipsoid has three sigma of the position, ellipsoid_scale times larger and
/// limited by the height. The path ahead is straight and ends on the ground. Everything except the runway
/// grows with the height.
/// header: stamp of the image, runway frame.
/// aircraft: if there is none, only runway, path and text are drawn, and the other markers are removed.
/// direction: of flight over the ground.
/// runway_width: as measured, m; unknown: as in the parameters.
LandingScene drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                         const LandingResult& estimate, const std::optional<DrawnAircraft>& aircraft,
                         const Eigen::Vector2d& direction, const std::deque<Eigen::Vector3d>& track,
                         double runway_width);

}  // namespace uav_landing
