#pragma once

#include <optional>
#include <vector>

#include "motion/step/step_matching.h"

namespace uav_landing {

/// Finds the motion of a frame step when nothing but the ground is known. It tries several speeds straight
/// ahead over the ground and takes the one that most corners agree with.
///
/// A complete search takes as long as several pairs whose motion is known. So each pair tries only some of
/// the speeds, on its own images. This works because the motion is nearly the same from one pair to the next.
class FirstStepSearch {
 public:
  /// at_once: try all speeds in the first pair, however long it takes.
  explicit FirstStepSearch(bool at_once) : at_once_(at_once) {}

  /// Continues the search with this step. Returns this step's motion once all speeds have been tried, before
  /// that nothing.
  std::optional<CameraMotion> advance(const StepMatching& matching, const StepImages& step);
  /// Whether this step has time for all speeds.
  bool isAtOnce(const StepImages& step) const;
  /// Starts a new search with the next step.
  void restart();
  /// Starts a new search and forgets earlier ones, too. Use it when other images come next.
  void reset();
  /// Tells the search that its result was wrong. If it used the known rotation, the next search does without
  /// it, and the other way round.
  void fail();

 private:
  // A motion with the duration of its step, s.
  struct Candidate {
    CameraMotion motion;
    double duration;
  };

  void clear();
  Eigen::Matrix3d rotation(const StepImages& step) const;
  void guess(const StepMatching& matching, const StepImages& step, double speed);
  bool isUnsure();  // few corners agree with the best guess, and it is time to compare all of them
  void compare(const StepMatching& matching, const StepImages& step, size_t count);
  CameraMotion follow(const StepMatching& matching, const StepImages& step,
                      const std::vector<TrackedCorner>& corners, const CameraMotion& start) const;
  std::optional<CameraMotion> end(const StepImages& step);

  bool at_once_;
  bool with_rotation_ = true;        // use the known rotation, when there is one
  size_t guessed_ = 0;               // number of speeds tried
  double share_ = 0;                 // share of the corners that agree with best_
  std::optional<Candidate> best_;    // best guess so far
  std::vector<Candidate> compared_;  // candidates for the comparison, in their order; empty until it begins
  size_t next_ = 0;                  // next candidate to compare
  std::optional<Candidate> alike_;   // the compared candidate under which the corners look most alike
  int unsure_ = 0;                   // successive searches that few corners agreed with
};

}  // namespace uav_landing
