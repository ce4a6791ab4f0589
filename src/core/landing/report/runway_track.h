#pragma once

#include <array>
#include <optional>

#include "height/height_filter.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Position of the camera from the runway's outline and its size in charts, followed over pairs.
struct TrackedPosition {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kUnknown);  ///< m, runway frame
  Eigen::Vector3d variance = Eigen::Vector3d::Constant(kUnknown);  ///< m^2
  double protection_level = kUnknown;                              ///< protection level of the height, m
  bool measured = false;                                           ///< whether this pair measured it
  Failure contradiction;  ///< set when the runway's size is not the chart's

  bool known() const { return position.allFinite(); }
};

/// Velocity of the camera along the runway's axes, m/s, m^2/s^2. NaN when it is not known.
struct RunwayVelocity {
  Eigen::Vector3d value = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d variance = Eigen::Vector3d::Constant(kUnknown);
};
/// Converts the velocity of a pair. normal: of the ground. direction: of the runway. Both in the camera
/// frame.
RunwayVelocity runwayVelocity(const LandingResult& landing, const Eigen::Vector3d& normal,
                              const Eigen::Vector3d& direction);

/// Follows the position from the outline with one filter per axis, of the same kind as the height's. When
/// stereo gives a speed, the filters use it, also for some seconds after the outline has become too large to
/// be fitted. Pairs have some of their errors in common, from the ground's texture and the paint. That part
/// of a measurement's variance does not average out.
///
/// The protection level of the height is the largest of
///   k sigma;
///   (effect of a chart that is wrong by 10 %) + k_f sigma;
///   (effect of disparities that are off by five times what is claimed of their bias) + k_f sigma;
///   |z - z_i| + k_f sigma_i, where z_i is the height without element i, if it contradicts z.
/// From afar nothing shows that a chart is wrong. When the runway is near, stereo measures it. If its size is
/// not the chart's, all lengths are wrong, so no position is reported.
class RunwayTrack {
 public:
  explicit RunwayTrack(const KalmanHeightParameters& parameters);

  /// T: s since the previous pair; 0 when that pair says nothing about this one.
  TrackedPosition follow(double T, const ApproachAngleResult::Sight& sight,
                         const RunwayVelocity& velocity = {});

 private:
  /// One coordinate with a filter like the height's. The filter starts again after it has rejected several
  /// measurements in a row.
  class Axis {
   public:
    explicit Axis(double speed_stddev);
    void predict(double T) { filter_.predict(T); }
    /// systematic: 1 sigma of the error that all measurements have in common.
    void update(double value, double variance, double systematic);
    void updateSpeed(double value, double variance) { filter_.updateSpeed(value, variance); }
    void forget();
    bool known() const { return filter_.initialised(); }
    double value() const { return filter_.state()[0]; }
    double variance() const { return filter_.covariance()(0, 0) + common_; }

   private:
    HeightFilter filter_;
    double common_ = 0;  // part of the last measurement's variance that the next ones share
    int rejected_ = 0;   // measurements in a row
  };
  /// By how much the height is off, as a share of it: by a wrong chart, as a share of the chart's error, and
  /// by one standard deviation of the disparity's bias.
  struct Influences {
    double chart = kUnknown, bias = kUnknown;
  };
  void measure(const ApproachAngleResult::Sight& sight);
  void compareSize(double T, const ApproachAngleResult::Sight& sight);
  double protectionLevel() const;
  void forget();

  KalmanHeightParameters parameters_;
  std::array<Axis, 3> axes_;     // x, y, z
  std::array<Axis, 3> without_;  // z without an element
  Influences influences_;        // on the last measurement
  double unseen_ = 0;            // s since the last measurement
  // Pairs with a size other than the chart's. Pairs with the chart's size count it down to 0.
  int other_size_ = 0;
  double size_ = kUnknown, size_variance_ = kUnknown;  // as a multiple of the chart's size
};

}  // namespace uav_landing
