#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Finds sudden changes of the rig's pitch and roll as vertical disparities show them (rig_rotation.h): a
/// camera was bent, or the images were not taken at the same time. Constant errors, such as those of lenses,
/// do not show.
class RigChange {
 public:
  struct Innovation {
    Eigen::Vector2d difference;  ///< of (rx, rz), rad
    Eigen::Matrix2d covariance;

    /// True for all but one in a thousand differences of pure noise.
    bool agrees() const;
    /// True when the difference is too large for noise, and large enough to matter.
    bool isLarge() const;
  };
  /// The difference to the mean of the pairs before. There is none for the first pairs.
  std::optional<Innovation> compare(const RigRotation& measured) const;
  /// Learns from a pair. T: s since the pair before. agrees: whether compare() found that it agrees.
  ///
  /// Pairs that do not agree are left out. After some seconds of them, the rotation is learned anew. A small
  /// change is accepted as soon as it has stayed the same for a second. This is safe even
  /// when the images do not belong together: their error of the height is proportional to the rotation that
  /// they show.
  ///
  /// Returns true when the rig has another rotation from now on.
  bool learn(double T, const RigRotation& measured, bool agrees);
  /// The mean of what was learned, as one measurement of pitch and roll.
  RigRotation mean() const;
  /// Whether the measurement says nothing about the rig. This is so while a new rotation has not settled. It
  /// is also so for a rotation far from those before that has not stayed the same for a second.
  bool doubts(const RigRotation& measured) const;
  /// False after a change, until the new rotation has been known for long enough to be the rig's. Images that
  /// do not belong together show a rotation that keeps changing.
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
  /// Averages the pairs that do not agree with the mean, as long as they agree with each other.
  void learnOther(double T, const RigRotation& measured);

  Mean mean_, other_;
  double disagreed_ = 0;  // s
  bool anew_ = false;     // the rotation is being learned anew
};

}  // namespace uav_landing
