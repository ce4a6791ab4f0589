#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "uav_landing/motion/imu_buffer.h"
#include "uav_landing/simulator/parameters.h"
#include "uav_landing/simulator/trajectory.h"

namespace uav_landing {

/// Rotation to the rectified left camera's optical frame from the simulated sensor's axes.
Eigen::Matrix3d opticalFromImu();

/// An inertial sensor that is fixed to the rig, message by message: attitude and angular velocity with
/// constant and random errors. Its axes are forward, left and up of the rectified left camera, apart from an
/// error of its mounting that nobody knows.
class SimulatedImu {
 public:
  SimulatedImu(const SimulatedImuParameters& parameters, const Trajectory& trajectory, uint64_t seed);

  /// Number of messages from the start to this many seconds after it, both included; 0 without a sensor.
  int count(double duration) const;
  /// Stamps are seconds since the start, late by the delay.
  ImuSample sample(int index) const;

 private:
  SimulatedImuParameters parameters_;
  Trajectory trajectory_;
  uint64_t seed_;
};

}  // namespace uav_landing
