#pragma once

#include <array>
#include <deque>
#include <limits>

namespace uav_landing {

/// Approach angle of the path now from the angles of the last steps and of one chord over all of them.
///
/// A chord over half a second is far more accurate than one step, but tells the angle a quarter of a second
/// ago. How much the angle may have changed since is not known beforehand: a steady glide, a flare and gusts
/// differ. So the path is a Gaussian process, a start angle plus the integral of a rate with correlation time
/// one second, in one model for each of several standard deviations of the rate; each model's weight is its
/// evidence, the likelihood of the recent measurements with old ones forgotten (multiple-model adaptive
/// estimation, Magill 1965). The result is the mixture's mean and variance. Only measurements of the last
/// window seconds enter the estimate itself. The error of the ground's normal is about the same in all of
/// them, but a long chord sees the ground from so different places that it hardly depends on the normal
/// given.
class PathAngleFilter {
 public:
  /// window: s, of measurements used.
  explicit PathAngleFilter(double window) : window_(window) {}

  struct Measurement {
    double angle = 0;      ///< rad
    double variance = 0;   ///< rad^2, of the matches alone
    double duration = 0;   ///< s, back from now
    double by_normal = 0;  ///< 1 sigma by the error of the ground's normal, about the same in all, rad
    /// By 1 sigma of the readout time, where that is not given: one error with its sign in all, rad.
    double by_readout = 0;
    bool shaken = false;  ///< by rows that move in themselves: the variance does not tell the error
  };
  struct Estimate {
    double angle = 0;        ///< of the middle of the last step, rad
    double variance = 0;     ///< rad^2, as that of the angle now as far as the step is longer than usual
    double rate_stddev = 0;  ///< rad/s, of the model with the most weight
  };

  /// stamp: end of the step, s. chord: over several of the steps, or equal to the step when there is none.
  Estimate update(double stamp, const Measurement& step, const Measurement& chord);
  void reset();

 private:
  static constexpr int kModels = 6;
  struct Step {
    double stamp;
    Measurement measurement;
  };

  struct Equations;
  class Regression;
  void add(double stamp, const Measurement& step);
  Equations equations(const Measurement& chord) const;

  double window_;
  std::deque<Step> steps_;  // oldest first
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double shortest_ = kNone;  // of the steps, s
  std::array<double, kModels> log_weights_{};
};

}  // namespace uav_landing
