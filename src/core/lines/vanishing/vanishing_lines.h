#pragma once

#include <Eigen/Core>
#include <vector>

#include "lines/segments/line_segment.h"
#include "lines/vanishing/vanishing_candidate.h"
#include "uav_landing/parameters/approach_angle_parameters.h"

namespace uav_landing {

/// The lines of one view among which those along the runway are looked for, and the limits of a direction for
/// that. It refers to the parameters and to the normal, which must outlive it.
class VanishingLines {
 public:
  /// prior_normal: of the ground, or null.
  VanishingLines(const std::vector<LineSegment>& lines, const Eigen::Matrix3d& K,
                 const ApproachAngleParameters& parameters, const Eigen::Vector3d* prior_normal);

  int count() const { return static_cast<int>(lines_.size()); }
  const VanishingCandidate& operator[](int i) const { return lines_[static_cast<size_t>(i)]; }
  const std::vector<VanishingCandidate>& all() const { return lines_; }
  const Eigen::Matrix3d& K() const { return K_; }
  const ApproachAngleParameters& parameters() const { return parameters_; }

  bool alongRunway(const Eigen::Vector3d& direction) const;
  /// Where two lines meet, as a direction towards +z; false when it is not along the runway.
  bool meeting(int i, int j, Eigen::Vector3d& direction) const;

  /// Distance by which a line's ends may miss, px. It contains the line's own errors, and that runways are
  /// not perfectly straight.
  double toleranceOf(const VanishingCandidate& line) const;
  /// Indices of the lines that pass through a direction within this tolerance.
  std::vector<int> passing(const Eigen::Vector3d& direction) const;

  /// Angle of a pixel along the horizon, over V.z. It is smaller farther to the side.
  double perPixel(const Eigen::Vector3d& V) const { return V.z() / (Kinv_ * V).squaredNorm(); }
  /// Angle on the ground over angle in the image, rad / px.
  double perTurn(const VanishingCandidate& line) const;

 private:
  std::vector<VanishingCandidate> lines_;
  Eigen::Matrix3d K_, Kinv_;
  const ApproachAngleParameters& parameters_;
  const Eigen::Vector3d* prior_normal_;
  Eigen::Vector2d horizon_;  // direction of the horizon in the image, unit vector
};

}  // namespace uav_landing
