#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "estimation/limits.h"
#include "geometry/ground_normal.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Ground normal over time: the normals of single pairs, averaged along the rotation between them.
/// Prediction: n' = R n with the step's rotation R. Then a Kalman update with the pair's normal, in the
/// tangent plane of n. Memory fades with one second, because after that time other ground lies ahead.
/// Averaging reduces only errors that differ from pair to pair; common errors (the rig's rotation) stay. A
/// turned rig tilts the plane in proportion to the height, so earlier, higher pairs tilt the mean more than
/// the last one.
class AttitudeFilter {
 public:
  static constexpr Sigmas kGate{5};               ///< of both angles together
  static constexpr Sigmas kDoubtful{3};           ///< from this value on a normal that agrees is in doubt
  static constexpr double kStampRounding = 1e-3;  ///< s, difference that stamps of the same pair may have

  /// Whether the step tells how the camera turned during the last T seconds. A step over another time does
  /// not.
  static bool tellsTurn(const ApproachAngleResult::Motion& step, double T);

  struct Estimate {
    Eigen::Vector3d normal;
    Eigen::Matrix3d covariance;  ///< rad^2, rank 2, without errors common to all pairs
    Eigen::Matrix3d common_root = Eigen::Matrix3d::Zero();  ///< symmetric root of the common errors'
                                                            ///< covariance
    /// Covariance of the normal as the average that it is, rad^2. The other covariance is larger, because it
    /// belongs to a memory that fades: old pairs count less.
    Eigen::Matrix3d average_covariance = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d commonCovariance() const { return common_root * common_root.transpose(); }
    double ratio = kUnknown;  ///< squared normalised difference from the pairs before
    bool agrees = true;       ///< the pairs before and the rotation allow the pair's normal
  };

  /// stamp: s.
  /// seen: the normal of this pair alone. Its covariance is that of errors that differ from pair to pair.
  /// step: from the previous pair.
  /// common: covariance of the errors that all pairs have alike, but for their size.
  /// fresh: share of the first covariance that is new in every pair. The rest is among the common part.
  ///
  /// Without a step the filter starts anew, but only after it has compared the normal with those before,
  /// using the turn that an aircraft may make. A normal that contradicts those before (another surface was
  /// taken for the ground) is not used, and agrees is false. After three seconds of contradictions the filter
  /// starts anew from the last normal. It does so at once while fewer than three pairs in a row have agreed.
  /// The filter keeps an alternative for four pairs in three cases: the step turns by more than usual, the
  /// normal only just agrees, or no step leads to it. When a later normal contradicts the estimate and agrees
  /// with the alternative, the alternative is taken.
  Estimate update(double stamp, const GroundNormal& seen, const ApproachAngleResult::Motion& step,
                  const Eigen::Matrix3d& common = Eigen::Matrix3d::Zero(), double fresh = 1);
  /// Call it for a pair without a normal.
  void carry(double stamp, const ApproachAngleResult::Motion& step);
  /// The last step turned by more than usual, and no normal has confirmed it, or one has denied it.
  bool doubtsTurn() const { return turn_doubted_; }
  /// No alternative is kept.
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
