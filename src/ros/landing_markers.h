#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "node_parameters.h"
#include "uav_landing/stage_results.h"

namespace uav_landing {

/// What rviz shows besides tf: the runway's outline and centre line (of the size in the parameters), the path
/// flown, the straight path ahead down to the ground, and the numbers as text. header: stamp of the image,
/// runway frame. position: of the aircraft, or none; then only runway, path and text are drawn.
visualization_msgs::MarkerArray drawLanding(const std_msgs::Header& header, const NodeParameters& parameters,
                                            const LandingResult& estimate,
                                            const std::optional<Eigen::Vector3d>& position,
                                            const Eigen::Vector2d& direction,
                                            const std::deque<Eigen::Vector3d>& track);

}  // namespace uav_landing
