#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kernels/samples/seen_rays.h"
#include "motion/matching/temporal_match.h"
#include "motion/step/motion_state.h"
#include "motion/step/row_shake.h"
#include "uav_landing/geometry/calibration.h"

namespace uav_landing {

/// How well a motion is supported: votes weighted by closeness, and how many matches it fits well. Telling
/// are matches that know both of their coordinates; others, as along a line, fit nearly any motion well.
using MotionSupport = RaySupport;

/// Sums of the normal equations by (rotation, t, n).
struct MotionNormal {
  Matrix9d information = Matrix9d::Zero();
  Vector9d right = Vector9d::Zero();
  int count = 0;              // of the matches with a weight
  double residual_scale = 1;  // robust size of the residuals over their stddevs
};

/// Sums of what one unknown more does to the residuals, and they with it: that unknown is a time.
struct SumsByTime {
  Vector9d with_motion = Vector9d::Zero();
  double information = 0, right = 0;
};

/// The least squares problem of a camera's motion: for each match two residuals (pixels) where it was then
/// less where the motion puts it, by columns, so that four matches are worked on at once. Keeps its memory.
class MotionRows {
 public:
  /// Distance, in pixels, by which a match may miss a motion in the consensus step.
  static constexpr double kTolerance = 2.0;

  void assign(const StereoRig& rig, const std::vector<TemporalMatch>& matches);
  size_t size() const { return count_; }
  /// The problem of these three alone.
  void assign(const MotionRows& all, const std::array<size_t, 3>& chosen);

  MotionSupport support(const MotionState& state) const;

  /// Residuals and Jacobians at a state. The two rows of a match are made independent of each other (LDL' of
  /// its covariance), each with its precision.
  void linearise(const MotionState& state);

  /// Sums with Tukey weights of the residuals, taken as large as their median says, but at least as claimed.
  /// inliers: which matches have a weight. After linearise().
  MotionNormal accumulate(std::vector<char>& inliers);

  /// What one match adds to the right side of the normal equations after one step more. After accumulate().
  Vector9d score(size_t match, const Vector9d& step) const;

  /// later: the same matches as they are a time (s) later, linearised at the same state. The residuals are
  /// those after one step more. After accumulate().
  SumsByTime sumsByTime(const MotionRows& later, double seconds, const Vector9d& step) const;

  /// Sums of nodes over the rows after one step more, of those that have matches beside them. shares: of the
  /// readout at which the matches are exposed. later: as above, or null where the readout time is no unknown.
  /// After accumulate().
  std::vector<RowNode> rowNodes(const std::vector<double>& shares, const Vector9d& step,
                                const MotionRows* later, double seconds) const;

  /// Rotation and translation that take away the residuals of three matches, the normal held; not finite when
  /// one lies behind the camera. After linearise().
  Eigen::Matrix<double, 6, 1> solveExactly() const;

 private:
  void resize(size_t count);
  double residualScale();

  Eigen::Vector4d camera_ = Eigen::Vector4d::Zero();  // fx, fy, cx, cy
  size_t count_ = 0, padded_ = 0;
  std::vector<double> inputs_, outputs_;  // by columns of padded_, as seen_rays.h has them
  std::vector<double> ratios_;
};

/// Memory that a fit works in: all matches, the three that are drawn, and those of another readout time.
struct MotionMemory {
  MotionRows all, drawn;
  std::vector<TemporalMatch> shifted;
};

}  // namespace uav_landing
