#pragma once

#include <deque>
#include <limits>
#include <vector>

namespace uav_landing {

/// Current approach angle from the angles of the last frame steps and of one chord over them.
///
/// A chord over half a second is far more accurate than one step, but its angle is a quarter of a second old.
/// The change of the angle since then is not known beforehand: a steady glide, a flare and gusts differ. So
/// the path is modelled as a Gaussian process: a start angle plus the integral of a rate with a correlation
/// time of one second.
///
/// There are several such models, each with another standard deviation of the rate. The weight of a model is
/// its evidence: the likelihood of the recent measurements, with older ones gradually forgotten
/// (multiple-model adaptive estimation, Magill 1965). The result is the mean and the variance of this
/// mixture. Only measurements of the last `window` seconds enter the estimate itself.
///
/// The error of the ground normal is about the same in all measurements. A long chord hardly depends on the
/// given normal, because it sees the ground from very different places.
///
/// Vibration turns the rows of a rolling shutter, and not every such turn shows in the images. It gives the
/// image an error. A step has that of its last image, minus that of its first, so it makes the steps' angles
/// jump to and fro. Further models have such errors of several sizes.
class PathAngleFilter {
 public:
  /// window: time over which measurements are used, s.
  explicit PathAngleFilter(double window) : window_(window) {}

  struct Measurement {
    double angle = 0;      ///< rad
    double variance = 0;   ///< rad^2, from the matches alone
    double duration = 0;   ///< s, ending now
    double by_normal = 0;  ///< 1 sigma from the error of the ground normal, similar in all measurements, rad
    /// Effect of 1 sigma of the readout time, when that is estimated, rad. The sign counts: it is one error,
    /// common to all measurements.
    double by_readout = 0;
    bool shaken = false;   ///< rows shake (see RowShake), so the variance does not describe the error
    bool rolling = false;  ///< rows have times of their own, so vibration may turn them unseen
  };
  struct Estimate {
    double angle = 0;  ///< at the middle of the last step, rad
    /// rad^2. After a step that is longer than usual, it also covers the additional change of the angle since
    /// that middle.
    double variance = 0;
    double rate_stddev = 0;  ///< the rate with the largest weight, rad/s
  };

  /// stamp: end of the step, s. chord: over several steps, or equal to the step when there is no chord.
  Estimate update(double stamp, const Measurement& step, const Measurement& chord);
  void reset();

 private:
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
  double shortest_ = kNone;          // duration of the shortest step so far, s
  std::vector<double> log_weights_;  // of the models
};

}  // namespace uav_landing
