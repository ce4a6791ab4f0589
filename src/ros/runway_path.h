#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "uav_landing/stage_results.h"

namespace uav_landing {

/// Where the left camera is in the runway frame. Only the height is measured; along and across the runway the
/// velocity is summed up from an arbitrary start: the point where the first path meets the ground becomes the
/// origin.
class RunwayPath {
 public:
  struct Position {
    Eigen::Vector3d position;  ///< m, runway frame
    Eigen::Vector2d variance;  ///< of x and y, m^2: huge and growing, as the start is not known
  };

  /// Of one pair; none while the height is not valid or the attitude unknown. A stamp that goes back starts
  /// anew.
  std::optional<Position> update(const LandingResult& camera);
  void reset();

  /// The positions so far, thinned out; the last kept ones.
  const std::deque<Eigen::Vector3d>& track() const { return track_; }

 private:
  void remember(const Eigen::Vector3d& position);

  std::optional<double> last_stamp_;
  Eigen::Vector2d xy_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // m/s, the last known
  double drift_stddev_ = 0;                             // m
  std::deque<Eigen::Vector3d> track_;
};

}  // namespace uav_landing
