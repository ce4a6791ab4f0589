#pragma once

#include <Eigen/Core>

namespace uav_landing {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Unknowns of the ego-motion. Q: rotation from now to then, perturbed on the left. t: translation in the
/// frame now, in heights. n: ground normal.
struct MotionState {
  Eigen::Matrix3d Q;
  Eigen::Vector3d t, n;

  MotionState apply(const Vector9d& step) const;
};

}  // namespace uav_landing
