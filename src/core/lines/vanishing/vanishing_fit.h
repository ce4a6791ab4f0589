#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/vanishing/vanishing_lines.h"
#include "lines/vanishing/vanishing_point.h"

namespace uav_landing {

using LineIndices = std::vector<int>;

/// Least squares on the sphere: the direction in which lines vanish, iterated from a rough one.
class VanishingFit {
 public:
  VanishingFit(const VanishingLines& lines, const Eigen::Vector3d& start)
      : lines_(lines), direction_(start) {}

  /// One Gauss-Newton step to the lines with these indices. Lines off by more than a few times their scatter
  /// count less (Cauchy). Returns the scatter before the step, 1 sigma over what the lines claim, at least 1.
  double robustStep(const LineIndices& used);
  /// The same step with all lines counting in full.
  void plainStep(const LineIndices& used);

  /// Unit vector; not finite when the lines are parallel.
  const Eigen::Vector3d& direction() const { return direction_; }
  /// Those of the lines that pass within this many sigmas of their own errors.
  LineIndices within(const LineIndices& used, double gate) const;
  /// The point with the covariance of the last step; fails when it is too uncertain.
  Expected<VanishingPoint> describe(const LineIndices& used) const;

 private:
  using Matrix32 = Eigen::Matrix<double, 3, 2>;

  std::vector<double> normalised(const LineIndices& used) const;
  void step(const LineIndices& used, double cauchy_scale);

  const VanishingLines& lines_;
  Eigen::Vector3d direction_;
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();  // of the direction along its tangents
  Matrix32 tangents_ = Matrix32::Zero();
};

}  // namespace uav_landing
