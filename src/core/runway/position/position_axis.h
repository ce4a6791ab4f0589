#pragma once

#include <Eigen/Core>

namespace uav_landing {

/// Position along one axis of the runway, m. Errors of the motion and of successive measurements are similar
/// from pair to pair. So their standard deviations are added, not their variances.
///
/// Measurements may share an error that is always the same, for example while only the bars of the threshold
/// are seen. Then value = position + sqrt(systematic) offset. The offset is unknown, N(0, 1), and is a second
/// state of the Kalman filter. It does not average out, but one measurement without this error determines it.
class PositionAxis {
 public:
  void predict(double movement, double stddev);
  /// value: measured position, m. variance: m^2. systematic: part of the variance that is the same error in
  /// all measurements. seconds: since the pair before. Returns whether the measurement is accepted.
  bool update(double value, double variance, double systematic, double seconds);
  void forgetAbove(double stddev);

  bool known() const { return known_; }
  double value() const { return state_(0); }
  double variance() const { return covariance_(0, 0) + common_; }
  /// Time with accepted measurements since it is known, s.
  double measured() const { return measured_; }

 private:
  bool known_ = false;
  Eigen::Vector2d state_ = Eigen::Vector2d::Zero();  // position, m; offset
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
  double common_ = 0;    // part of the last measurement's variance that does not average out
  double rejected_ = 0;  // s of rejected measurements in a row
  double measured_ = 0;
};

}  // namespace uav_landing
