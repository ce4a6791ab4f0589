#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kernels/samples/seen_rays.h"
#include "motion/matching/temporal_match.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_node.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// Support of a motion: votes weighted by closeness, and the number of matches that it fits well. A match is
/// telling when both of its coordinates are certain. Other matches, for example along a line, fit nearly any
/// motion well.
using MotionSupport = RaySupport;

/// Sums of the normal equations. The unknowns are rotation, translation and normal, in this order.
struct MotionNormal {
  Matrix9d information = Matrix9d::Zero();
  Vector9d right = Vector9d::Zero();
  int count = 0;              // matches with a weight
  double residual_scale = 1;  // robust size of the residuals over their standard deviations
};

/// Sums of the normal equations for one more unknown, a time: its products with the motion, with itself, and
/// with the residuals.
struct SumsByTime {
  Vector9d with_motion = Vector9d::Zero();
  double information = 0, right = 0;
};

/// The least squares problem of a camera's motion. Each match has two residuals: its place in the image then
/// minus the place that the motion predicts, in pixels. Data is stored by columns, so that four matches are
/// computed at once. The object keeps its memory between uses.
class MotionRows {
 public:
  /// Distance by which a match may miss a motion in the consensus step, pixels.
  static constexpr double kTolerance = 2.0;

  void assign(const StereoRig& rig, const std::vector<TemporalMatch>& matches);
  size_t size() const { return count_; }
  /// Takes only these three matches of another problem.
  void assign(const MotionRows& all, const std::array<size_t, 3>& chosen);

  MotionSupport support(const MotionState& state) const;

  /// Computes residuals and Jacobians at a state. The two rows of a match are made independent of each other
  /// (LDL' of the match's covariance), and each has its precision.
  void linearise(const MotionState& state);

  /// Sums up the normal equations with Tukey weights. Standard deviations are scaled up when the median of
  /// the residuals is larger than the matches claim, and never down. inliers: receives 1 for each match with
  /// a weight. Call it after linearise().
  MotionNormal accumulate(std::vector<char>& inliers);

  /// Contribution of one match to the right side of the normal equations, after one more step. Call it after
  /// accumulate().
  Vector9d score(size_t match, const Vector9d& step) const;

  /// Sums for the unknown time. later: the same matches with a readout time that is longer by `seconds`,
  /// linearised at the same state. The residuals are those after one more step. Call it after accumulate().
  SumsByTime sumsByTime(const MotionRows& later, double seconds, const Vector9d& step) const;

  /// Sums for the nodes of a rotation over the rows, after one more step. The first node is before the first
  /// match, the last one after the last match. shares: times of the matches as a share of the readout.
  /// later: as above. It is null when the readout time is no unknown. Call it after accumulate().
  std::vector<RowNode> rowNodes(const std::vector<double>& shares, const Vector9d& step,
                                const MotionRows* later, double seconds) const;

  /// Rotation and translation that bring the residuals of three matches to zero while the normal stays fixed.
  /// Not finite when one of the matches lies behind the camera. Call it after linearise().
  Eigen::Matrix<double, 6, 1> solveExactly() const;

 private:
  void resize(size_t count);
  double residualScale();

  Eigen::Vector4d camera_ = Eigen::Vector4d::Zero();  // fx, fy, cx, cy
  size_t count_ = 0, padded_ = 0;
  std::vector<double> inputs_, outputs_;  // columns of padded_ values, see seen_rays.h
  std::vector<double> ratios_;
};

}  // namespace uav_landing
