#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "motion/step/motion_state.h"

namespace uav_landing {

/// What matches say of a rotation that the camera has beside its motion at one time of the readout. Between
/// two such times it is linear. Sums of the normal equations, after the motion that fits all matches.
struct RowNode {
  static constexpr int kInReadout = 16;  ///< vibration is nearly linear in one part

  double share = 0;                                     ///< of the readout
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();   ///< information on it
  Eigen::Matrix3d with_next = Eigen::Matrix3d::Zero();  ///< product with the node below it
  Eigen::Matrix<double, 3, 9> with_motion = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d with_time = Eigen::Vector3d::Zero();  ///< with a readout time that is not given
  Eigen::Vector3d score = Eigen::Vector3d::Zero();      ///< right side
  double squares = 0;  ///< of the residuals over their stddevs from here to the next node, weighted
  int count = 0;       ///< of matches there
};

/// What the pairs of about a second say of the shake's size: a pair alone does not see it in every phase.
class ShakeMemory {
 public:
  /// Cycles of vibration in a readout, and standard deviations of the rotation, that are looked for (rad).
  static constexpr std::array<double, 6> kCycles = {0.4, 0.7, 1.1, 1.7, 2.6, 4};
  static constexpr int kStddevs = 21;
  static double stddev(int k);

  struct Size {
    double stddev = 0, cycles = 0;
    double likelihood = 0;  ///< ratio to that without shake, its logarithm
  };
  /// Logarithms of the ratios for one pair, by cycles and stddevs.
  using Likelihoods = std::array<std::array<double, kStddevs>, kCycles.size()>;
  void add(const Likelihoods& pair);
  Size likeliest() const;

 private:
  Likelihoods sums_ = {};
};

/// Rotations of the camera while rows are exposed, as random numbers of one variance that are alike at times
/// that are close: vibration through a rolling shutter. They are unknowns beside the motion, and taken out of
/// its normal equations.
struct RowShake {
  double variance = 0;   ///< rad^2, of each axis
  Matrix9d information;  ///< on the motion, less what the shake hides
  Vector9d step;         ///< to the motion that fits best with it
  /// By how much sums with a readout time that is not given are less, its right side after that step.
  double time_information = 0, time_right = 0;
  Vector9d time_with_motion = Vector9d::Zero();

  bool found() const { return variance > 0; }
};

/// What a readout time that is not given has to do with a motion, by the sums of the normal equations, about
/// the motion that fits without it.
struct TimeUnknown {
  Vector9d with_motion = Vector9d::Zero();
  double information = 0;  ///< with that beforehand, 1/s^2
  double right = 0;
};

/// information: of the motion, with priors. time: one unknown more, which is no shake. What no such rotation
/// explains is the matches' noise, however little they claim. Found is only what is far beyond that, with the
/// pairs before.
RowShake findRowShake(const std::vector<RowNode>& nodes, const Matrix9d& information, const TimeUnknown& time,
                      ShakeMemory& memory);

}  // namespace uav_landing
