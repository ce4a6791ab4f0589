#pragma once

#include <Eigen/Core>

#include "height/common_variance.h"

namespace uav_landing {

/// The paper's Kalman filter for the height, eqs (6)-(8): state (height, vertical speed, positive up), white
/// random acceleration. It has the Joseph form and an innovation gate.
/// Part of a height's variance may be common to all pairs (calibration, surface), and must not average out.
/// It counts in the gate and in the gain, so the filter is cautious in case it changes. A second covariance,
/// that of errors independent from pair to pair, is without it and is carried along with the same gains (a
/// consider covariance, Schmidt: Application of state-space methods to navigation problems, Advances in
/// Control Systems 3, 1966). The common errors are carried along, too: the state has of each measurement what
/// its gain gave it, and errors of one cause add up with their sign.
class HeightFilter {
 public:
  /// acceleration_stddev: m/s^2, of eta in eq (7). initial_speed_stddev: m/s. gate: largest normalised
  /// innovation, sigmas.
  HeightFilter(double acceleration_stddev, double initial_speed_stddev, double gate);

  struct Update {
    double innovation = 0;           ///< measured minus predicted; m, of a speed m/s
    double innovation_variance = 0;  ///< of the innovation, both uncertainties added; m^2, of a speed m^2/s^2
    double gate_variance = 0;        ///< the same plus unequal shares of the baseline's error
    bool accepted = false;
  };

  bool initialised() const { return initialised_; }
  /// Starts at a height (m, m^2) with speed 0. common: part of the variance.
  void initialise(double height, double variance, const CommonVariance& common = {});
  /// Eq (7) over T seconds, T >= 0.
  void predict(double T);
  /// Eq (8) with a measured height (m, m^2). A measurement beyond the gate changes nothing. common: part of
  /// the variance.
  Update update(double height, double variance, const CommonVariance& common = {});
  /// The same with a measured vertical speed (positive up, m/s, m^2/s^2). Not in the paper.
  Update updateSpeed(double speed, double variance);
  void reset() { initialised_ = false; }

  const Eigen::Vector2d& state() const { return state_; }  ///< m, m/s
  const Eigen::Matrix2d& covariance() const { return covariance_; }
  /// Covariance of errors independent from pair to pair; add it to the common variance.
  const Eigen::Matrix2d& ownCovariance() const { return own_; }
  /// Variance of the height from errors that its measurements have in common.
  CommonVariance commonVariance() const;

 private:
  /// baseline_variance: of the difference between state and measurement due to the baseline.
  Update fuse(const Eigen::RowVector2d& observation, double measured, double variance,
              const CommonVariance& common, double baseline_variance);

  double acceleration_stddev_, initial_speed_stddev_, gate_;
  bool initialised_ = false;
  Eigen::Vector2d state_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero(), own_ = Eigen::Matrix2d::Zero();
  // 1 sigma of the state by each common cause, with signs.
  Eigen::Matrix<double, 2, 4> common_ = Eigen::Matrix<double, 2, 4>::Zero();
};

}  // namespace uav_landing
