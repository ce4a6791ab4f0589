#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position over the runway in metres: where it is measured the measurement smoothed over time, in between
/// the motion summed up with growing variance. x and y are filtered by themselves and known from their first
/// measurement on, until the uncertainty makes them worthless or the time jumps.
class PositionFilter {
 public:
  /// Of one pair. normal: of the ground, left camera frame. turn: how the camera turned since the pair
  /// before. height: m, with variance; NaN while it is not valid. Fills x, y, the runway's width and their
  /// variances of the result.
  void process(const ApproachAngleResult& approach, const Eigen::Vector3d& normal,
               const ApproachAngleResult::Motion& turn, double height, double height_variance,
               LandingResult& result);

 private:
  /// Position along one axis. Errors of the motion and of successive measurements are much the same from pair
  /// to pair, so standard deviations are added, not variances. Measurements may have an error in common that
  /// is always the same, as when only the threshold's bars are seen: value = position + systematic * offset
  /// with an unknown offset of N(0, 1), which is a second state of the Kalman filter. It does not average
  /// out, and one measurement without it tells it.
  class Axis {
   public:
    void predict(double movement, double stddev);
    /// value, variance: measured, m, m^2. systematic: part of the variance.
    void update(double value, double variance, double systematic, double seconds);
    void forgetAbove(double stddev);
    void report(double& value, double& reported) const;

   private:
    double variance() const { return covariance_(0, 0) + common_; }

    bool known_ = false;
    Eigen::Vector2d state_ = Eigen::Vector2d::Zero();  // position, m; offset
    Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
    double common_ = 0;    // variance that does not average out, of the last measurement
    double rejected_ = 0;  // s
  };

  /// seen: the runway's direction, where it is.
  void followDirection(const Eigen::Vector3d& seen, const ApproachAngleResult::Motion& turn, double seconds);
  void move(const ApproachAngleResult& approach, const Eigen::Vector3d& normal, double height,
            double seconds);

  Axis x_, y_;
  std::optional<double> last_stamp_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Constant(kUnknown);  // of landing, left camera frame
  double unseen_turn_ = 0;                                           // 1 sigma of it, rad
  std::optional<Eigen::Vector2d> velocity_;                          // along and across the runway, m/s
  double width_ = 0;                                                 // m, last seen
};

}  // namespace uav_landing
