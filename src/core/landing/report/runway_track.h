#pragma once

#include <array>
#include <optional>

#include "height/height_filter.h"
#include "uav_landing/parameters/kalman_height_parameters.h"
#include "uav_landing/parameters/runway_parameters.h"
#include "uav_landing/results/stage_results.h"

namespace uav_landing {

/// Where the camera is by the runway's outline and its size in charts, over the pairs.
struct TrackedPosition {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kUnknown);  ///< m, runway frame
  Eigen::Vector3d variance = Eigen::Vector3d::Constant(kUnknown);  ///< m^2
  double protection_level = kUnknown;                              ///< of the height, m
  bool measured = false;                                           ///< on this pair
  Failure contradiction;                                           ///< the chart's size is not the runway's

  bool known() const { return position.allFinite(); }
};

/// Velocity of the camera along the runway's axes, m/s, m^2/s^2; NaN where it is not known.
struct RunwayVelocity {
  Eigen::Vector3d value = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d variance = Eigen::Vector3d::Constant(kUnknown);
};
/// By the velocity of a pair. normal: of the ground; direction: of the runway, camera's frame.
RunwayVelocity runwayVelocity(const LandingResult& landing, const Eigen::Vector3d& normal,
                              const Eigen::Vector3d& direction);

/// Follows the position by the outline with a filter for each axis, as the height has it. Where stereo tells
/// the speed it follows that, also some seconds after the outline has become too large to be fitted. Pairs
/// have some of their errors in common (the ground's texture, what is painted); that part of a measurement's
/// variance does not average out.
///
/// The protection level of the height is the largest of
///   k sigma;  what a chart that is wrong by 10 % does to it + k_f sigma;
///   |z - z_i| + k_f sigma_i, z_i without element i, where that contradicts z.
/// Nothing tells a wrong chart from afar. Near, stereo measures the runway: a size other than the chart's
/// takes the position away, as all lengths are wrong by it.
class RunwayTrack {
 public:
  RunwayTrack(const KalmanHeightParameters& parameters, const RunwayParameters& runway);

  /// T: since the pair before, s; 0: that says nothing of this one.
  TrackedPosition follow(double T, const ApproachAngleResult::Sight& sight,
                         const RunwayVelocity& velocity = {});

 private:
  /// One coordinate by the height's filter, which begins anew when it has rejected some in a row.
  class Axis {
   public:
    explicit Axis(double speed_stddev);
    void predict(double T) { filter_.predict(T); }
    /// systematic: 1 sigma that all measurements have in common.
    void update(double value, double variance, double systematic);
    void updateSpeed(double value, double variance) { filter_.updateSpeed(value, variance); }
    void forget();
    bool known() const { return filter_.initialised(); }
    double value() const { return filter_.state()[0]; }
    double variance() const { return filter_.covariance()(0, 0) + common_; }

   private:
    HeightFilter filter_;
    double common_ = 0;  // variance of the last measurement that the next ones have, too
    int rejected_ = 0;   // measurements in a row
  };
  void measure(const ApproachAngleResult::Sight& sight);
  void compareSize(double T, const ApproachAngleResult::Sight& sight);
  double protectionLevel() const;
  void forget();

  KalmanHeightParameters parameters_;
  RunwayParameters runway_;
  std::array<Axis, 3> axes_;     // x, y, z
  std::array<Axis, 3> without_;  // z without an element
  double unseen_ = 0;            // s
  int other_size_ = 0;           // pairs in a row with a size other than the chart's; negative: with the same
  double size_ = kUnknown, size_variance_ = kUnknown;  // over the chart's
};

}  // namespace uav_landing
