#pragma once

#include <Eigen/Core>
#include <optional>

#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position over the runway in metres. Measurements are smoothed over time. Between them the motion is summed
/// up while the variance grows. x and y are filtered separately. Each is known from its first measurement
/// until it is too uncertain to be useful.
class PositionFilter {
 public:
  /// Processes one pair and fills x, y, the runway's width and their variances in the result.
  /// - normal: of the ground, left camera frame.
  /// - turn: motion since the previous pair, used for its rotation.
  /// - height: m, with its variance in m^2; NaN while it is not valid.
  void process(const ApproachAngleResult& approach, const Eigen::Vector3d& normal,
               const ApproachAngleResult::Motion& turn, double height, double height_variance,
               LandingResult& result);

 private:
  /// Position along one axis. Errors of the motion and of successive measurements are similar from pair to
  /// pair. So their standard deviations are added, not their variances.
  ///
  /// Measurements may share an error that is always the same, for example while only the bars of the
  /// threshold are seen. Then value = position + sqrt(systematic) offset. The offset is unknown, N(0, 1), and
  /// is a second state of the Kalman filter. It does not average out, but one measurement without this error
  /// determines it.
  class Axis {
   public:
    void predict(double movement, double stddev);
    /// value: measured position, m. variance: m^2. systematic: part of the variance that is the same error in
    /// all measurements.
    void update(double value, double variance, double systematic, double seconds);
    void forgetAbove(double stddev);
    void report(double& value, double& reported) const;

   private:
    double variance() const { return covariance_(0, 0) + common_; }

    bool known_ = false;
    Eigen::Vector2d state_ = Eigen::Vector2d::Zero();  // position, m; offset
    Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
    double common_ = 0;    // part of the last measurement's variance that does not average out
    double rejected_ = 0;  // s of rejected measurements in a row
  };

  /// seen: direction of the runway in this pair, not finite when it is not seen.
  void followDirection(const Eigen::Vector3d& seen, const ApproachAngleResult::Motion& turn, double seconds);
  void move(const ApproachAngleResult& approach, const Eigen::Vector3d& normal, double height,
            double seconds);

  Axis x_, y_;
  std::optional<double> last_stamp_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Constant(kUnknown);  // landing direction, left camera frame
  double unseen_turn_ = 0;                   // 1 sigma of direction_ from turns that were not measured, rad
  std::optional<Eigen::Vector2d> velocity_;  // along and across the runway, m/s
  double width_ = 0;                         // last seen, m
};

}  // namespace uav_landing
