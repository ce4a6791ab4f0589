#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position of the left camera in the runway frame. Along and across the runway it is that of the estimate,
/// when this is known. Until then the velocity is summed up from an arbitrary start: the origin is the point
/// where the first path meets the ground. It also has the width of the runway, for drawing.
class RunwayPath {
 public:
  struct Position {
    Eigen::Vector3d position;  ///< m, runway frame
    Eigen::Vector2d variance;  ///< of x and y, m^2: huge and growing while not known
  };

  /// The position at a pair; none while the height is not valid or the attitude is unknown. A stamp that goes
  /// back starts anew.
  std::optional<Position> update(const LandingResult& camera);
  void reset();

  /// The last positions, thinned out.
  const std::deque<Eigen::Vector3d>& track() const { return track_; }
  /// Mean width over the last pairs that measured it, as some take other lines for the edges, m; unknown:
  /// none has.
  double runwayWidth() const { return widths_ > 0 ? runway_width_ : kUnknown; }

 private:
  /// For x (axis 0) or y (1), when it is known.
  void takeKnown(int axis, double value, double value_variance, Eigen::Vector2d& variance);
  void remember(const Eigen::Vector3d& position);

  std::optional<double> last_stamp_;
  Eigen::Vector2d xy_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // m/s, the last known
  double drift_stddev_ = 0;                             // m
  bool known_[2] = {false, false};                      // x, y: of the last estimate
  std::deque<Eigen::Vector3d> track_;
  int widths_ = 0;           // pairs that measured it
  double runway_width_ = 0;  // m
};

}  // namespace uav_landing
