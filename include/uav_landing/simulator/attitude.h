#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Attitude of a camera over the runway, rad. Pitch is the elevation of the optical axis, negative when
/// looking down. Roll is positive with the right side down. Yaw is positive to the left of the landing
/// direction.
struct Attitude {
  double roll = 0, pitch = 0, yaw = 0;
};

/// Rotation from optical axes (x right, y down, z forward) to body axes (x forward, y left, z up), REP 103.
Eigen::Matrix3d bodyFromOptical();

/// R(runway <- optical) = Rz(yaw) Ry(-pitch) Rx(roll) R(body <- optical). The runway frame has x along the
/// landing direction, y left, z up. The sign of pitch differs from REP 103, where nose down is positive.
Eigen::Matrix3d runwayFromOptical(const Attitude& attitude);

}  // namespace uav_landing
