#pragma once

#include <optional>
#include <vector>

#include "motion/step/step_matching.h"

namespace uav_landing {

/// The motion of a step of which nothing is known but the ground: straight ahead over it at several speeds,
/// that with which most corners agree.
///
/// That takes as long as several pairs whose motion is known. So each pair tries some of the speeds, on its
/// own images: from one pair to the next the motion is nearly the same.
class FirstStepSearch {
 public:
  /// at_once: all speeds in the first pair, however long it takes.
  explicit FirstStepSearch(bool at_once) : at_once_(at_once) {}

  /// Goes on with this step. The motion of this step after the last speed; before that nothing.
  std::optional<CameraMotion> advance(const StepMatching& matching, const StepImages& step);
  /// Whether this step has time for all speeds.
  bool isAtOnce(const StepImages& step) const;
  /// Begins anew with the next step.
  void restart();
  /// Forgets earlier searches, too. The next step is of other images.
  void reset();
  /// What was found leads nowhere. The next search does without a rotation known beforehand if this one
  /// had it, and the other way round.
  void fail();

 private:
  // A motion, and of how long a step.
  struct Candidate {
    CameraMotion motion;
    double duration;
  };

  void clear();
  Eigen::Matrix3d rotation(const StepImages& step) const;
  void guess(const StepMatching& matching, const StepImages& step, double speed);
  bool isUnsure();  // so that all corners have to be compared
  void compare(const StepMatching& matching, const StepImages& step, size_t count);
  CameraMotion follow(const StepMatching& matching, const StepImages& step,
                      const std::vector<TrackedCorner>& corners, const CameraMotion& start) const;
  std::optional<CameraMotion> end(const StepImages& step);

  bool at_once_;
  bool with_rotation_ = true;        // where one is known
  size_t guessed_ = 0;               // speeds
  double share_ = 0;                 // of the corners that agree with the best
  std::optional<Candidate> best_;    // of the guesses
  std::vector<Candidate> compared_;  // in the order in which all corners are compared; empty before that
  size_t next_ = 0;                  // of them
  std::optional<Candidate> alike_;   // of those before, with which corners look most alike
  int unsure_ = 0;                   // searches in a row that few corners agreed with
};

}  // namespace uav_landing
