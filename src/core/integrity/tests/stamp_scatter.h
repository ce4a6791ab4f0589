#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// Measures errors of stamps by the camera's speed over the ground. The speed of an aircraft does not change
/// from pair to pair. If it seems to, the durations between the stamps are wrong.
class StampScatter {
 public:
  /// acceleration: by which the aircraft can change its speed, m/s^2.
  explicit StampScatter(double acceleration) : acceleration_(acceleration) {}

  /// follow() takes a step with its duration by the stamps. skip() is for a step that is not known.
  void follow(const CameraStep& step);
  void skip() { last_.reset(); }
  /// Variance of the durations over their squares, in the last seconds. 0 when no errors show.
  double ofDuration() const;

 private:
  struct Speed {
    double logarithm = 0, variance = 0;  // of the speed in m/s, and its variance
  };
  double acceleration_;
  std::optional<Speed> last_;
  std::deque<double> changes_;  // squared changes of the logarithm, less what is expected of them
};

}  // namespace uav_landing
