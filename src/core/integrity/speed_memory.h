#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// The camera's speed on the pairs before: a picture that stands still while the aircraft cannot have stopped
/// is that of a camera that hangs, even where noise or light make every image another one.
class SpeedMemory {
 public:
  /// max_deceleration: m/s^2, by which the aircraft can lose speed.
  explicit SpeedMemory(double max_deceleration) : max_deceleration_(max_deceleration) {}

  /// By how much less the camera moved than it must have, and the variance of that.
  struct Shortfall {
    double difference = 0, variance = 0;  ///< m, negative when it moved enough; m^2
  };
  /// Against the slowest of the three steps known last (some may be wrong), less what can be lost since. A
  /// third of that way is enough: late stamps make steps look longer or shorter than they were. None where it
  /// may have stopped.
  std::optional<Shortfall> compare(const CameraStep& step) const;
  /// A step that agrees, as compared. What is known falls no faster than the aircraft can slow down, whatever
  /// the step: one so uncertain that it agrees would make the next, shorter one agree. One that does not
  /// leaves the speed as it was: the aircraft does not slow down while its pictures stand still. After that
  /// as many steps in a row (up to three) must be long enough, whatever their variance: pictures that change
  /// seem to move now and then. After half a minute nothing is known.
  void learn(const CameraStep& step, bool agrees);
  /// The last steps known stood still, and no motion has been seen since.
  bool stands() const { return still_ > 0; }
  /// A pair that tells nothing of the motion. duration: s.
  void skip(double duration) { since_ += still_ > 0 ? 0 : duration; }
  void reset() { *this = SpeedMemory(max_deceleration_); }

 private:
  struct Speed {
    double mean = 0, variance = 0;  // m/s, m^2/s^2
  };
  // After a step of this duration (s); none where it may have stopped.
  std::optional<Speed> least(double duration) const;

  double max_deceleration_;
  std::deque<Speed> last_;     // of the last steps known, up to three
  double since_ = 0;           // s, since the last known step
  double contradicted_ = 0;    // s
  int still_ = 0, moved_ = 0;  // steps that stood still, up to three, and those in a row since that did not
};

}  // namespace uav_landing
