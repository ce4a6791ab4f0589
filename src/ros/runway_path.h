#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position of the left camera in the runway frame. Along and across the runway it is that of the estimate,
/// when this is known. Until then the velocity is summed up from an arbitrary start: the origin is the point
/// where the first path meets the ground. The class also keeps the width of the runway, for drawing.
class RunwayPath {
 public:
  struct Position {
    Eigen::Vector3d position;  ///< m, runway frame
    Eigen::Vector2d variance;  ///< of x and y, m^2; huge and growing while they are not known
  };

  /// The position at a pair. There is none while the height is not valid or the attitude is unknown. When a
  /// stamp goes back, the path starts anew.
  std::optional<Position> update(const LandingResult& camera);
  void reset();

  /// The last positions, thinned out.
  const std::deque<Eigen::Vector3d>& track() const { return track_; }
  /// Mean width over the last pairs that measured it, m. The mean is used because some pairs take other lines
  /// for the edges. Unknown when no pair has measured it.
  double runwayWidth() const { return widths_ > 0 ? runway_width_ : kUnknown; }

 private:
  /// Takes x (axis 0) or y (axis 1) from the estimate when it is known.
  void takeKnown(int axis, double value, double value_variance, Eigen::Vector2d& variance);
  void remember(const Eigen::Vector3d& position);

  std::optional<double> last_stamp_;
  Eigen::Vector2d xy_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // m/s, the last known one
  double drift_stddev_ = 0;                             // m
  bool known_[2] = {false, false};                      // whether x and y of the last estimate were known
  std::deque<Eigen::Vector3d> track_;
  int widths_ = 0;           // number of pairs that measured it
  double runway_width_ = 0;  // m
};

}  // namespace uav_landing
