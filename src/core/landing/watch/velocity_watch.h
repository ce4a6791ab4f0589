#pragma once

#include <limits>

#include "integrity/memory/velocity_memory.h"
#include "integrity/tests/pair_tests.h"
#include "landing/height/pair_input.h"

namespace uav_landing {

/// Tests the step since the previous pair against the velocity of earlier steps. A contradiction only makes
/// the angle less certain, because an error in the direction of flight hardly changes a height.
class VelocityWatch {
 public:
  /// longest_window: longest sliding window of an approach angle, s.
  explicit VelocityWatch(double longest_window) : longest_window_(longest_window) {}

  struct Verdict {
    Eigen::Vector3d change = Eigen::Vector3d::Zero();  ///< difference from the velocity of earlier steps, m/s
    /// Possible error of the approach angle because of steps that contradicted, rad. path_doubt holds as long
    /// as such a step is in the sliding window; step_doubt belongs to this step.
    double path_doubt = 0, step_doubt = 0;
    double agreed = std::numeric_limits<double>::infinity();  ///< s of steps since one that contradicted
  };
  /// Tests the step of a pair. Do not call it for a repeated image, because the next step covers the time of
  /// both. height: m. duration_variance: of durations between stamps, divided by their squares.
  Verdict follow(const PairInput& in, double height, double duration_variance, PairTests& tests);
  /// Verdict for a pair without a new step.
  Verdict verdict() const;

 private:
  void compare(const PairInput& in, const VelocityMemory::Step& step, PairTests& tests, Verdict& verdict);

  double longest_window_;
  VelocityMemory velocity_;
  double window_ = 0;  // recent length of the angle's window, s
  // Angle of the last contradicting steps minus the expected one, absolute value, rad.
  double doubt_ = 0;
};

}  // namespace uav_landing
