#pragma once

#include "integrity/pair_tests.h"
#include "integrity/velocity_memory.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// The step since the pair before against the velocity on those before that. Only the angle is less certain
/// for a contradiction: what is wrong in the direction of flight hardly changes a height.
class VelocityWatch {
 public:
  /// longest_window: s, of an approach angle.
  explicit VelocityWatch(double longest_window) : longest_window_(longest_window) {}

  struct Verdict {
    Eigen::Vector3d change = Eigen::Vector3d::Zero();  ///< against the pairs before, m/s
    /// By how much the approach angle may be wrong for steps that contradicted, rad: of the path, which has
    /// such a step in it for as long as the window is, and of the step alone.
    double path_doubt = 0, step_doubt = 0;
  };
  /// Not of a picture that came once more: the next step is over the time of both. height: m.
  /// duration_variance: of durations between stamps, over their squares.
  Verdict follow(const PairInput& in, double height, double duration_variance, PairTests& tests);
  /// Without a new step.
  Verdict verdict() const;

 private:
  void compare(const PairInput& in, const VelocityMemory::Step& step, PairTests& tests, Verdict& verdict);

  double longest_window_;
  VelocityMemory velocity_;
  double window_ = 0;  // of the angles of late, s
  double doubt_ = 0;   // angle of the last steps that contradicted less the one expected, rad
};

}  // namespace uav_landing
