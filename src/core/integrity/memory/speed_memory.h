#pragma once

#include <deque>
#include <optional>

#include "results/camera_step.h"

namespace uav_landing {

/// The camera's speed on the pairs before. If the image stands still while the aircraft cannot have stopped,
/// the camera is frozen. This holds even if noise or light change every image.
class SpeedMemory {
 public:
  /// max_deceleration: largest one of the aircraft, m/s^2.
  explicit SpeedMemory(double max_deceleration) : max_deceleration_(max_deceleration) {}

  /// Missing part of the distance that the camera must have moved at least, and its variance.
  struct Shortfall {
    double difference = 0, variance = 0;  ///< m, negative when it moved enough; m^2
  };
  /// Compares a step with the slowest of the last three known steps, because some may be wrong. The aircraft
  /// may have slowed down since. A third of the distance that remains is enough, because late stamps make
  /// steps look longer or shorter. There is no result when the aircraft may have stopped.
  std::optional<Shortfall> compare(const CameraStep& step) const;
  /// Learns from a step. agrees: result of the test.
  ///
  /// The known speed falls no faster than the aircraft can slow down, whatever the step says. Otherwise a
  /// step that is so uncertain that it agrees would make the next, shorter one agree.
  ///
  /// A step that does not agree leaves the speed as it was, because the aircraft does not slow down while its
  /// images stand still. After that, as many steps in a row (up to three) must be long enough, whatever their
  /// variance: changing images seem to move now and then. After half a minute nothing is known.
  void learn(const CameraStep& step, bool agrees);
  /// True when the last known steps stood still and no motion has been seen since.
  bool stands() const { return still_ > 0; }
  /// A pair without a motion. duration: s.
  void skip(double duration) { since_ += still_ > 0 ? 0 : duration; }
  void reset() { *this = SpeedMemory(max_deceleration_); }

 private:
  struct Speed {
    double mean = 0, variance = 0;  // m/s, m^2/s^2
  };
  // Lowest speed after a step of this duration (s). There is none when the aircraft may have stopped.
  std::optional<Speed> least(double duration) const;

  double max_deceleration_;
  std::deque<Speed> last_;     // of the last known steps, up to three
  double since_ = 0;           // s, since the last known step
  double contradicted_ = 0;    // s
  int still_ = 0, moved_ = 0;  // steps that stood still, up to three; steps in a row since then that moved
};

}  // namespace uav_landing
