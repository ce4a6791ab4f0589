#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <optional>

#include "motion/matching/camera_motion.h"
#include "motion/step/row_unknowns.h"
#include "motion/step/turn_history.h"
#include "uav_landing/geometry/row_turns.h"
#include "uav_landing/results/attitude_prior.h"

namespace uav_landing {

/// Constant error of an inertial sensor's angular velocity, from steps that both images and sensor tell.
class GyroBias {
 public:
  /// stddev: 1 sigma before any step, rad/s.
  explicit GyroBias(double stddev) : stddev_(std::max(stddev, kLeast)) {}
  /// off: rate by the images minus that of the sensor, over one step, rad/s.
  void add(const Eigen::Vector3d& off);
  Eigen::Vector3d mean() const;
  double variance() const;  ///< of each axis, (rad/s)^2

 private:
  static constexpr double kLeast = 1e-6;  // rad/s; no sensor has none

  double stepsBeforehand() const;  // that would tell as much

  double stddev_, steps_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
};

/// Error of the delay of an inertial sensor's messages (imu_delay), from what it does to the rows.
class GyroDelay {
 public:
  void add(const DelayEffect& effect, double duration);
  double late() const { return late_; }          ///< by which images see it later, s
  double variance() const { return variance_; }  ///< s^2

 private:
  static constexpr double kBeforehand = 2e-3;  // 1 sigma of a delay that was measured, s
  double late_ = 0, variance_ = kBeforehand * kBeforehand;
};

/// Velocities of the camera while its rows are exposed: by an inertial sensor of a high rate where there is
/// one, or else by the turns of the last steps.
class RowRates {
 public:
  /// gyro_bias: 1 sigma of the bias of the sensor's angular velocity, rad/s.
  explicit RowRates(double gyro_bias) : bias_(gyro_bias) {}

  /// Call it before the step to an image. imu: of that image.
  void see(const AttitudePrior& imu);
  /// Mean rate of turn at that image by the sensor, rad/s, where it tells it.
  std::optional<Eigen::Vector3d> measuredNow() const;
  /// Velocities in the step to that image. duration: s. height_then: in heights now.
  StepEnds ends(const CameraMotion& step, double duration, double height_then) const;
  /// Velocities at an image whose step is not known yet. last: those at the image before, which is so old, s.
  /// imu: of this image.
  RowMotion expected(const RowMotion& last, double age, const AttitudePrior& imu) const;
  /// What these velocities may be off by; the rest of the result is left as it is by default. readout: time
  /// of all rows, s.
  RowDoubt doubt(double duration, double readout) const;
  /// Call it after the step.
  void add(const CameraMotion& step, double duration, const DelayEffect& effect);
  /// Call it when there is no step to that image. The next one begins there.
  void skip();

 private:
  bool measured() const { return now_.rows && then_.rows; }
  GyroTurn gyroOf(const AttitudePrior& imu) const { return {imu.rows, delay_.late()}; }
  Eigen::Vector3d meanRate(const AttitudePrior& imu) const { return imu.rows->meanRate() + bias_.mean(); }
  void setRate(const AttitudePrior& imu, RowMotion& motion) const;

  TurnHistory history_;
  AttitudePrior then_, now_;
  GyroBias bias_;
  GyroDelay delay_;
};

}  // namespace uav_landing
