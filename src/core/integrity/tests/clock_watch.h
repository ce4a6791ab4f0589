#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// Notices a clock that was set between two pairs. The stamps then tell another time than the distance that
/// the camera moved, and that distance belongs to one frame period or a few.
///
/// An aircraft's speed hardly changes from pair to pair. So the distance since the pair before, over the
/// speed of the last steps, is the time that has really passed. Three other events do not look like a clock
/// that was set. A dropped frame moves the camera by two periods, and the stamps by as much. A frozen image
/// does not move the camera. Brakes change the distance by some per cent.
class ClockWatch {
 public:
  /// Follows a step, with its duration by the stamps. When the two contradict each other, returns the time by
  /// the distance instead, s. Returns nothing when they agree, or before enough steps were regular.
  std::optional<double> follow(const CameraStep& step);
  /// A pair whose motion is not known. Later steps are no evidence until they are regular again.
  void skip();

 private:
  struct Step {
    double duration = 0, speed = 0;  // s, m/s
  };
  std::deque<Step> regular_;  // the last steps, as long as stamps and distances agree
};

}  // namespace uav_landing
