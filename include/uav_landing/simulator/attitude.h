#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Attitude of a camera over the runway, radians. Pitch: elevation of the optical axis, looking down is
/// negative. Roll: right side down is positive. Yaw: left of the landing direction is positive.
struct Attitude {
  double roll = 0, pitch = 0, yaw = 0;
};

/// Rotation from optical axes (x right, y down, z forward) to body axes (x forward, y left, z up), REP 103.
Eigen::Matrix3d bodyFromOptical();

/// R(runway <- optical) = Rz(yaw) Ry(-pitch) Rx(roll) R(body <- optical), with the runway frame x along the
/// landing direction, y left, z up. The sign of pitch differs from REP 103, where nose down is positive.
Eigen::Matrix3d runwayFromOptical(const Attitude& attitude);

}  // namespace uav_landing
