#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// How wrong stamps are, by the camera's speed over the ground: an aircraft's does not change from pair to
/// pair, so that where it seems to, the durations between the stamps are wrong.
class StampScatter {
 public:
  /// acceleration: m/s^2, by which the aircraft can change its speed.
  explicit StampScatter(double acceleration) : acceleration_(acceleration) {}

  /// A step, its duration by the stamps; one that is not known.
  void follow(const CameraStep& step);
  void skip() { last_.reset(); }
  /// Variance of the durations over their squares, of the last seconds; 0 when they are as good as shows.
  double ofDuration() const;

 private:
  struct Speed {
    double logarithm = 0, variance = 0;  // of m/s; its variance
  };
  double acceleration_;
  std::optional<Speed> last_;
  std::deque<double> changes_;  // squared, of the logarithm, less what they may be
};

}  // namespace uav_landing
