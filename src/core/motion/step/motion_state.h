#pragma once

#include <Eigen/Core>

namespace uav_landing {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// The unknowns of ego-motion: rotation now -> then (perturbed on the left), translation, ground normal.
struct MotionState {
  Eigen::Matrix3d Q;
  Eigen::Vector3d t, n;

  MotionState apply(const Vector9d& step) const;
};

}  // namespace uav_landing
