#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "uav_landing/motion/imu_buffer.h"
#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// Rotation from the simulated sensor's axes to the optical frame of the rectified left camera.
Eigen::Matrix3d opticalFromImu();

/// An inertial sensor that is fixed to the rig. Its messages have attitude and angular velocity with constant
/// and random errors. Its axes are forward, left and up of the rectified left camera, apart from an unknown
/// error of its mounting.
class SimulatedImu {
 public:
  SimulatedImu(const SimulatedImuParameters& parameters, const Trajectory& trajectory, uint64_t seed);

  /// Number of messages in this many seconds from the start, both ends included; 0 without a sensor.
  int count(double duration) const;
  /// The message with this index. Stamps are seconds since the start; the delay makes them late.
  ImuSample sample(int index) const;

 private:
  SimulatedImuParameters parameters_;
  Trajectory trajectory_;
  uint64_t seed_;
};

}  // namespace uav_landing
