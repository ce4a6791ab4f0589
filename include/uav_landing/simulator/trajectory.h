#pragma once

#include <Eigen/Core>

#include "uav_landing/results/truth.h"
#include "uav_landing/simulator/attitude.h"
#include "uav_landing/simulator/parameters.h"

namespace uav_landing {

/// Pose of the rectified left camera at a time: position in the runway frame, m, and attitude.
struct CameraPose {
  Eigen::Vector3d position;
  Attitude attitude;
};

/// A straight glide, a flare with a constant rate of the path's angle, then a straight path again. Wobble, a
/// gust and vibration are added. The path is also defined between the frames and before the start.
class Trajectory {
 public:
  Trajectory(const SimulatedPathParameters& path, const SimulatedWobbleParameters& wobble,
             const SimulatedGustParameters& gust, uint64_t seed,
             const SimulatedVibrationParameters& vibration = {});

  /// t: seconds since the start.
  CameraPose pose(double t) const;
  /// Time at which the flare begins, s; infinite when there is none.
  double flareStart() const { return flare_start_; }

 private:
  /// Two sines with a common amplitude and period.
  struct Wobble {
    double amplitude, period, phase, fast_phase;
    double at(double t) const;
  };
  /// Distance forward and down that was flown after t seconds without wobble, m.
  Eigen::Vector2d advance(double t) const;
  /// Height lost by the gust after t seconds, m.
  double lostToGust(double t) const;
  /// Attitude that the vibration adds.
  Attitude vibrationAt(double t) const;

  SimulatedPathParameters path_;
  SimulatedGustParameters gust_;
  SimulatedVibrationParameters vibration_;
  double flare_start_;
  Wobble roll_, pitch_, yaw_, sway_, heave_;
  Attitude vibration_phase_;
};

/// Truth of a frame from its pose and that of the previous frame. previous: null for the first frame. dt: s
/// between the two. K: of the rectified left camera.
Truth truthOf(const CameraPose& pose, const CameraPose* previous, double dt, const Eigen::Matrix3d& K);

}  // namespace uav_landing
