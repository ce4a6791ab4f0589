#pragma once

#include <Eigen/Core>
#include <vector>

namespace uav_landing {

/// How the camera turned around the stamp of an image, as an inertial sensor with a high rate measured it.
/// Rotations are those of the scene in the optical frame of the rectified left camera, as in AttitudePrior.
class RowTurns {
 public:
  static constexpr double kInterval = 1e-3;  ///< s, between two rates

  /// first: time of the first rate, s since the stamp; not later than the stamp. rates: rad/s, at least two;
  /// the last one is not before the stamp. covariance: of their mean by the sensor's noise, (rad/s)^2.
  RowTurns(double first, std::vector<Eigen::Vector3d> rates, const Eigen::Matrix3d& covariance);

  /// Mean rate, rad/s, and its covariance by the sensor's noise. The sensor's bias is not in it.
  const Eigen::Vector3d& meanRate() const { return mean_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// Rotation vector from the stamp to some seconds after it, minus that of the mean rate, rad.
  Eigen::Vector3d beyondMean(double seconds) const;
  /// Rate some seconds after the stamp, rad/s. The first and the last one hold on.
  Eigen::Vector3d rateAt(double seconds) const;

 private:
  Eigen::Vector3d turnTo(double seconds) const;

  double first_;
  std::vector<Eigen::Vector3d> rates_, turns_;  // turns since the first rate
  Eigen::Vector3d at_stamp_, mean_;
  Eigen::Matrix3d covariance_;
};

}  // namespace uav_landing
