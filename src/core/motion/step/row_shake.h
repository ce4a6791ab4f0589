#pragma once

#include <Eigen/Core>
#include <array>

#include "geometry/vibration.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_node.h"
#include "motion/step/row_sums.h"
#include "uav_landing/geometry/row_times.h"

namespace uav_landing {

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
  /// What counts is the last look at a pair.
  void add(const Likelihoods& pair);
  /// Instead of add(), for a pair without a sign of shake.
  void fade() { add({}); }
  /// Call it before each pair of images that counts on its own.
  void begin() { before_ = sums_; }
  Size likeliest() const;

 private:
  Likelihoods before_ = {}, sums_ = {};  // without this pair, and with it
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
/// taken out of the normal equations of the motion.
struct RowShake {
  Vibration vibration;
  Vector9d step = Vector9d::Zero();  ///< change of the motion to the one that fits best with the shake

  bool found() const { return vibration.found(); }
};

/// Looks for shake in one pair, and takes it out of the sums when there is some. Any part of the residuals
/// that no rotation can explain counts as noise of the matches, even if they claim less. Shake is found only
/// when it is far beyond that noise over this pair and the previous ones. A rig that has turned makes the
/// normal wrong, and that would look like shake. So the normal counts as unknown while the shutter is taken
/// as global. A readout time that is estimated is another unknown, as it would look like shake, too.
///
/// Where rows have times, shake is suspected before it is found, as when vibration begins. It is taken out
/// then, too, so that the motion claims it.
RowShake findRowShake(const ShakeWatch& watch, ShakeShapes& shapes, RowSums& sums);

}  // namespace uav_landing
