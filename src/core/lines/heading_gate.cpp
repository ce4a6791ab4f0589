#include "lines/heading_gate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace uav_landing {

namespace {

constexpr double kSlack = 5 * M_PI / 180;  // by which the direction of a rough line may be off
constexpr double kWidest = 85 * M_PI / 180;

}  // namespace

// The direction of a line on the ground is that of (K^T l) x n.
HeadingGate::HeadingGate(const Eigen::Matrix3d& K, const Eigen::Vector3d& normal, double max_yaw)
    : ahead_(K * normal.cross(Eigen::Vector3d::UnitZ())),
      aside_(K * normal.cross(Eigen::Vector3d::UnitX())),
      slope_(std::tan(std::min(max_yaw + kSlack, kWidest))) {}

bool HeadingGate::passes(const Eigen::Vector3d& line) const {
  return std::abs(aside_.dot(line)) <= slope_ * std::abs(ahead_.dot(line));
}

}  // namespace uav_landing
