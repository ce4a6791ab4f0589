#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "estimation/limits.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Ground normal over the frames: the normals of single pairs, averaged along the rotation between them.
///
/// n' = R n with the step's rotation R, then a Kalman update with the pair's normal, in the tangent plane of
/// n. Memory fades with one second, because the ground ahead is another one by then. Only what differs from
/// pair to pair averages out; what is common to all (the rig's rotation) stays. A turned rig tilts the plane
/// in proportion to the height: the mean of pairs that were higher is tilted more than the last one.
class AttitudeFilter {
 public:
  static constexpr Sigmas kGate{5};               ///< of the two angles together
  static constexpr Sigmas kDoubtful{3};           ///< the same, from which a normal that agrees is in doubt
  static constexpr double kStampRounding = 1e-3;  ///< s, by which stamps of the same pairs may differ

  /// Whether the step tells how the camera turned in the last T seconds: one that spans another time does
  /// not.
  static bool tellsTurn(const ApproachAngleResult::Motion& step, double T);

  struct Estimate {
    Eigen::Vector3d normal;
    Eigen::Matrix3d covariance;  ///< rad^2, rank 2, without what is common to all pairs
    Eigen::Matrix3d common_root = Eigen::Matrix3d::Zero();  ///< symmetric root of what is common to them
    /// Of the average that the normal is, rad^2: that of fading memory is larger, as old pairs count less.
    Eigen::Matrix3d average_covariance = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d commonCovariance() const { return common_root * common_root.transpose(); }
    double ratio = kUnknown;  ///< squared normalised difference to the pairs before
    bool agrees = true;       ///< the pair's normal is one that the pairs before and the rotation allow
  };

  /// stamp: s. normal: unit, of this pair alone; covariance: rad^2, of what differs from pair to pair;
  /// common: of what is the same in all but for its size; fresh: share of the covariance that is new in every
  /// pair, the rest being among the common one. step: from the previous pair; without one the
  /// filter starts anew, but not before the normal has been compared with those before by what a camera
  /// turns. A normal that contradicts the ones before (another surface was taken for the ground) is left out
  /// and agrees is false; when that goes on for three seconds, the filter starts anew from it, and at once as
  /// long as fewer than three pairs in a row have agreed. Where a step turns by more than is usual, or a
  /// normal is taken that only just agrees or that no step leads to, what would be without it is kept for
  /// four pairs: when a normal contradicts the one and agrees with the other, that one is taken.
  Estimate update(double stamp, const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance,
                  const ApproachAngleResult::Motion& step,
                  const Eigen::Matrix3d& common = Eigen::Matrix3d::Zero(), double fresh = 1);
  /// A pair without a normal.
  void carry(double stamp, const ApproachAngleResult::Motion& step);
  /// The last step turned by more than is usual, and no normal has confirmed that, or one has denied it.
  bool doubtsTurn() const { return turn_doubted_; }
  /// Nothing is in doubt.
  bool settled() const { return !other_; }
  void reset();

 private:
  enum class Prediction { kNone, kTurned, kGuessed };
  Prediction predict(double stamp, const ApproachAngleResult::Motion& step);
  void turn(double T, const Eigen::Matrix3d& R, const ApproachAngleResult::Motion& step);
  void guess(double T);
  void doubt(const Estimate& other, bool turn);
  Estimate start(const Eigen::Vector3d& normal, const Eigen::Matrix3d& covariance,
                 const Eigen::Matrix3d& common_root, const Eigen::Matrix3d& fresh);

  std::optional<Estimate> estimate_;
  std::optional<Estimate> other_;  // without the turn or the normal that is in doubt
  bool other_is_turn_ = false;
  int doubts_left_ = 0;  // pairs
  bool turn_doubted_ = false;
  double stamp_ = 0, agreed_ = 0;  // s
  int agreements_ = 0;             // in a row since the start, up to three
};

}  // namespace uav_landing
