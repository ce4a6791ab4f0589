#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// Notices a clock that was set between two pairs: the stamps tell another time than the camera's way, and
/// that way is the one of a frame period or a few.
///
/// An aircraft's speed hardly changes from pair to pair. So the way since the pair before, over the speed of
/// the last steps, is the time that has really passed. A dropped frame moves the camera by two periods and
/// the stamps by as much; a frozen picture does not move it; brakes change the way by some per cent. None of
/// these looks like a clock that was set.
class ClockWatch {
 public:
  /// A step, its duration by the stamps. Returns the time that the camera's way tells instead (s), where the
  /// two contradict each other; nothing where they agree, or before enough steps were regular.
  std::optional<double> follow(const CameraStep& step);
  /// A pair whose motion is not known. What follows is no evidence until steps are regular again.
  void skip();

 private:
  struct Step {
    double duration = 0, speed = 0;  // s, m/s
  };
  std::deque<Step> regular_;  // the last steps, as long as stamps and ways agree
};

}  // namespace uav_landing
