#pragma once

#include <Eigen/Core>
#include <optional>

#include "runway/position/position_axis.h"
#include "runway/position/position_separation.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position over the runway in metres. Measurements are smoothed over time. Between them the motion is summed
/// up while the variance grows. x and y are filtered separately. Each is known from its first measurement
/// until it is too uncertain to be useful. y has a protection level. While the sources of its last
/// measurement contradict each other by what matters, y is not known.
class PositionFilter {
 public:
  explicit PositionFilter(const KalmanHeightParameters& parameters);

  /// Processes one pair. Fills x, y, the runway's width, their variances and the protection level of y
  /// in the result, which has its stamp.
  ///
  /// - normal: of the ground, left camera frame.
  /// - turn: motion since the previous pair, used for its rotation.
  /// - height: its value is NaN while the height is not valid.
  void process(const ApproachAngleResult& approach, const Eigen::Vector3d& normal,
               const ApproachAngleResult::Motion& turn, const PositionSeparation::Height& height,
               LandingResult& result);

 private:
  /// seen: direction of the runway in this pair, not finite when it is not seen.
  void followDirection(const Eigen::Vector3d& seen, const ApproachAngleResult::Motion& turn, double seconds);
  void move(const ApproachAngleResult& approach, const Eigen::Vector3d& normal, double height,
            double seconds);
  void moveAcross(double movement, double stddev);

  PositionAxis x_, y_;
  PositionSeparation separation_;  // of y
  std::optional<double> last_stamp_;
  Eigen::Vector3d direction_ = Eigen::Vector3d::Constant(kUnknown);  // landing direction, left camera frame
  double unseen_turn_ = 0;                   // 1 sigma of direction_ from turns that were not measured, rad
  std::optional<Eigen::Vector2d> velocity_;  // along and across the runway, m/s
  double width_ = 0;                         // last seen, m
  double y_carried_ = 0;                     // s since the last measurement of y
  bool y_contradicted_ = false;              // by its sources, in that measurement
};

}  // namespace uav_landing
