#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Sudden changes of what vertical disparities show of the rig's pitch and roll (rig_rotation.h): a camera
/// that was bent, or images that were not taken at the same time. Constant errors, of lenses for instance, do
/// not show.
class RigChange {
 public:
  struct Innovation {
    Eigen::Vector2d difference;  ///< of (rx, rz), rad
    Eigen::Matrix2d covariance;

    /// But for one in a thousand.
    bool agrees() const;
    /// Far off, and for certain.
    bool isLarge() const;
  };
  /// Against the mean of the pairs before; none for the first ones.
  std::optional<Innovation> compare(const RigRotation& measured) const;
  /// T: s since the pair before. agrees: as compared. What does not agree is left out for some seconds; what
  /// comes then is learned anew. A small change is the rig's as soon as it has stayed the same for a second:
  /// what images that do not belong together do to the height goes with the rotation that they show. True
  /// when another rotation than before is the rig's from now on.
  bool learn(double T, const RigRotation& measured, bool agrees);
  /// What has been learned, as one measurement of the pitch and roll.
  RigRotation mean() const;
  /// Whether it says nothing of the rig: far from the pairs before, and has not stayed the same for a second,
  /// or what came after another rotation has not settled.
  bool doubts(const RigRotation& measured) const;
  /// False while another rotation than before is not yet known for long enough to be the rig's: that of
  /// images that do not belong together changes.
  bool settled() const;
  void reset() { *this = RigChange(); }

 private:
  struct Mean {
    Eigen::Vector2d value = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    double learned = 0;  // s

    Innovation compare(const RigRotation& measured) const;
    void add(double T, const RigRotation& measured);
  };
  /// The pairs that do not agree, as long as they agree with each other.
  void learnOther(double T, const RigRotation& measured);

  Mean mean_, other_;
  double disagreed_ = 0;  // s
  bool anew_ = false;     // after another rotation
};

}  // namespace uav_landing
