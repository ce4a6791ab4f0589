#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "node_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Where the left camera is in the runway frame, for drawing.
struct DrawnAircraft {
  Eigen::Vector3d position;            ///< m
  Eigen::Vector3d stddev;              ///< of position, m
  Eigen::Matrix3d runway_from_camera;  ///< rectified left camera, optical axes
};

/// What rviz shows besides the images.
struct LandingScene {
  visualization_msgs::MarkerArray markers;
  /// Runway frame to landing_view, where the view of rviz/landing.rviz is from: level, behind, right of and
  /// above the aircraft, as many heights away as make it look the same from far and near.
  geometry_msgs::TransformStamped view;
};

/// The runway's outline and centre line, the path flown, the aircraft with the ellipsoid of three sigma
/// (ellipsoid_scale times larger, cut to the height), the straight path ahead down to the ground, and the
/// numbers as text. All but the runway grows with the height. header: stamp of the image, runway frame.
/// aircraft: or none; then only runway, path and text are drawn, and the others taken away. direction: of
/// flight over the ground. runway_width: as measured, m; not known: as in the parameters.
LandingScene drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                         const LandingResult& estimate, const std::optional<DrawnAircraft>& aircraft,
                         const Eigen::Vector2d& direction, const std::deque<Eigen::Vector3d>& track,
                         double runway_width);

}  // namespace uav_landing
