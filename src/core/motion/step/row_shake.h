#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "motion/step/motion_state.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

/// A rotation of the camera in addition to its motion, at one time within the readout; it is linear between
/// two such nodes. The node holds the sums of the normal equations from the matches, after the motion that
/// fits them best.
struct RowNode {
  /// Nodes in a readout. Vibration is nearly linear between two of them.
  static constexpr int kInReadout = 16;

  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();   ///< information on the rotation
  Eigen::Matrix3d with_next = Eigen::Matrix3d::Zero();  ///< product with the rotation of the next node
  Eigen::Matrix<double, 3, 9> with_motion = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d with_time = Eigen::Vector3d::Zero();  ///< product with an estimated readout time
  Eigen::Vector3d score = Eigen::Vector3d::Zero();      ///< right side of the normal equations
  double squares = 0;  ///< weighted sum of squared residuals over their stddevs, up to the next node
  int count = 0;       ///< number of matches up to the next node
};

/// Remembers what the pairs of about one second say about the size of the shake. One pair is not enough,
/// because it sees the vibration in one phase only.
class ShakeMemory {
 public:
  /// Hypotheses: cycles of vibration in one readout, and standard deviations of the rotation, rad.
  static constexpr std::array<double, 6> kCycles = {0.4, 0.7, 1.1, 1.7, 2.6, 4};
  static constexpr int kStddevs = 21;
  static double stddev(int k);

  struct Size {
    size_t cycles = 0;      ///< which of kCycles
    double stddev = 0;      ///< rad
    double likelihood = 0;  ///< logarithm of the likelihood ratio to no shake
  };
  /// Logarithms of the likelihood ratios for one pair. Indices: cycles, then standard deviations.
  using Likelihoods = std::array<std::array<double, kStddevs>, kCycles.size()>;
  void add(const Likelihoods& pair);
  /// Instead of add(), for a pair without a sign of shake.
  void fade() { add({}); }
  Size likeliest() const;

 private:
  Likelihoods sums_ = {};
};

/// Where to look for shake.
struct ShakeWatch {
  const RowTimes* rows = nullptr;  ///< rows that vibration may turn; null: all are exposed at once
  ShakeMemory* memory = nullptr;
  /// False while the shutter is taken as global, as nothing is told of it. Then most pairs show no sign of
  /// shake, and the likelihoods are not worked out for them.
  bool rolling = true;
};

/// Shapes over the nodes that shake around one frequency can have. Shake is smooth over the nodes, so a few
/// shapes have nearly all of its variance. The object keeps them between uses.
class ShakeShapes {
 public:
  /// A matrix L for each of ShakeMemory::kCycles. The rows are the nodes. L L' is the covariance of one axis
  /// of a shake of unit variance.
  using Roots = std::array<Eigen::MatrixXd, ShakeMemory::kCycles.size()>;
  const Roots& of(Eigen::Index nodes);

 private:
  Roots roots_;
};

/// Rotations of the camera while rows are exposed, as vibration causes them with a rolling shutter. They are
/// random numbers of one variance, and similar at times that are close. They are additional unknowns and are
/// eliminated from the normal equations of the motion.
struct RowShake {
  double variance = 0;   ///< rad^2, of each axis
  Matrix9d information;  ///< information on the motion, reduced by the shake
  Vector9d step;         ///< change of the motion to the one that fits best with the shake
  /// Parts to subtract from the sums of the readout time, when that is estimated. time_right applies after
  /// `step`.
  double time_information = 0, time_right = 0;
  Vector9d time_with_motion = Vector9d::Zero();

  bool found() const { return variance > 0; }
};

/// Normal equations of the motion, at the one that fits best.
struct MotionUnknown {
  Matrix9d information;  ///< priors included
  /// The same with a normal that hardly anything is known of, and the right side, as the motion does not fit
  /// best then.
  Matrix9d information_with_any_normal;
  Vector9d right_with_any_normal;
};

/// Normal equations of a readout time that is estimated: sums at the motion that fits best without it.
struct TimeUnknown {
  Vector9d with_motion = Vector9d::Zero();
  double information = 0;  ///< prior included, 1/s^2
  double right = 0;
};

/// Looks for shake in the nodes of one pair. Any part of the residuals that no rotation can explain counts as
/// noise of the matches, even if they claim less. Shake is found only when it is far beyond that noise over
/// this pair and the previous ones. A rig that has turned makes the normal wrong, and that would look like
/// shake. So the normal counts as unknown while the shutter is taken as global. nodes: one after the other,
/// without gaps. time: another unknown, as it would look like shake, too.
RowShake findRowShake(const std::vector<RowNode>& nodes, const MotionUnknown& motion, const TimeUnknown& time,
                      const ShakeWatch& watch, ShakeShapes& shapes);

}  // namespace uav_landing
