#pragma once

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

/// What rviz shows besides tf: the runway's outline and centre line (of the size in the parameters), the path
/// flown, the aircraft with the ellipsoid of three sigma (ellipsoid_scale times larger), the straight path
/// ahead down to the ground, and the numbers as text. header: stamp of the image, runway frame. aircraft: or
/// none; then only runway, path and text are drawn, and the others taken away. direction: of flight over the
/// ground.
visualization_msgs::MarkerArray drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                                            const LandingResult& estimate,
                                            const std::optional<DrawnAircraft>& aircraft,
                                            const Eigen::Vector2d& direction,
                                            const std::deque<Eigen::Vector3d>& track);

}  // namespace uav_landing
