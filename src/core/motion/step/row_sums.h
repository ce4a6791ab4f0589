#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/step/motion_rows.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_node.h"

namespace uav_landing {

/// Normal equations of the motion, at the one that fits best.
struct MotionUnknown {
  Matrix9d information;  ///< priors included
  /// The same with a normal that hardly anything is known of, and the right side, as the motion does not fit
  /// best then.
  Matrix9d information_with_any_normal;
  Vector9d right_with_any_normal;
};

/// Normal equations of a motion, of rotations of the nodes besides, and of a readout time where it is
/// estimated. A rotation of the nodes that is random with a known covariance can be taken out. The rest is
/// what the matches say when that rotation is free to that extent.
struct RowSums {
  RowSums(const std::vector<RowNode>& nodes, const MotionUnknown& of_motion, const SumsByTime& of_time);

  /// Takes out rotations of the covariance L L'. root: L, three rows for each node. noise: factor by which
  /// the matches' variances are larger than they claim. Returns the change of the motion to the one that fits
  /// best then.
  Vector9d takeOut(const Eigen::MatrixXd& root, double noise = 1);

  Eigen::MatrixXd rotation;     ///< information on the rotations
  Eigen::MatrixXd with_motion;  ///< their products with the motion
  Eigen::VectorXd score, with_time;
  double squares = 0;  ///< weighted sum of squared residuals over their stddevs; exact without a prior
  int count = 0;       ///< number of matches
  MotionUnknown motion;
  SumsByTime by_time;
};

}  // namespace uav_landing
