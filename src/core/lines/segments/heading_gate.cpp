#include "lines/segments/heading_gate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace uav_landing {

namespace {

constexpr double kSlack = 5 * M_PI / 180;  // error of the direction of a rough line
constexpr double kWidest = 85 * M_PI / 180;

}  // namespace

// A line l on the ground has the direction (K^T l) x n.
HeadingGate::HeadingGate(const Eigen::Matrix3d& K, const Eigen::Vector3d& normal, double max_yaw)
    : ahead_(K * normal.cross(Eigen::Vector3d::UnitZ())),
      aside_(K * normal.cross(Eigen::Vector3d::UnitX())),
      slope_(std::tan(std::min(max_yaw + kSlack, kWidest))) {}

bool HeadingGate::passes(const Eigen::Vector3d& line) const {
  return std::abs(aside_.dot(line)) <= slope_ * std::abs(ahead_.dot(line));
}

}  // namespace uav_landing
