#pragma once

#include <Eigen/Core>

#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/attitude.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Where the rectified left camera is at a time: position in the runway frame, m, and attitude.
struct CameraPose {
  Eigen::Vector3d position;
  Attitude attitude;
};

/// Straight glide, flare at a steady rate of the path's angle, straight again; on it the wobble, a gust and
/// vibration. It is defined between the frames and before the start, too.
class Trajectory {
 public:
  Trajectory(const SimulatedPathParameters& path, const SimulatedWobbleParameters& wobble,
             const SimulatedGustParameters& gust, uint64_t seed,
             const SimulatedVibrationParameters& vibration = {});

  /// t: seconds since the start.
  CameraPose pose(double t) const;
  /// When the flare begins, s; infinite when there is none.
  double flareStart() const { return flare_start_; }

 private:
  /// Two sines of one amplitude and period.
  struct Wobble {
    double amplitude, period, phase, fast_phase;
    double at(double t) const;
  };
  /// Distance gone forward and down after t seconds without wobble, m.
  Eigen::Vector2d advance(double t) const;
  /// Height lost to the gust after t seconds, m.
  double lostToGust(double t) const;
  /// What the vibration adds to the attitude.
  Attitude vibrationAt(double t) const;

  SimulatedPathParameters path_;
  SimulatedGustParameters gust_;
  SimulatedVibrationParameters vibration_;
  double flare_start_;
  Wobble roll_, pitch_, yaw_, sway_, heave_;
  Attitude vibration_phase_;
};

/// Truth of a frame from its pose and that of the previous one (null for the first), dt seconds before. K: of
/// the rectified left camera.
Truth truthOf(const CameraPose& pose, const CameraPose* previous, double dt, const Eigen::Matrix3d& K);

}  // namespace uav_landing
