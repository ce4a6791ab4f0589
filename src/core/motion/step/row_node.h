#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// A rotation of the camera in addition to its motion, at one time within the readout; it is linear between
/// two such nodes. The node holds the sums of the normal equations from the matches, after the motion that
/// fits them best.
struct RowNode {
  /// Nodes in a readout. Vibration is nearly linear between two of them.
  static constexpr int kInReadout = 16;

  double share = 0;                                     ///< time since the stamp, as a share of the readout
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();   ///< information on the rotation
  Eigen::Matrix3d with_next = Eigen::Matrix3d::Zero();  ///< product with the rotation of the next node
  Eigen::Matrix<double, 3, 9> with_motion = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d with_time = Eigen::Vector3d::Zero();  ///< product with an estimated readout time
  Eigen::Vector3d score = Eigen::Vector3d::Zero();      ///< right side of the normal equations
  double squares = 0;  ///< weighted sum of squared residuals over their stddevs, up to the next node
  int count = 0;       ///< number of matches up to the next node
};

}  // namespace uav_landing
