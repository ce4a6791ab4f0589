#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace uav_landing {

/// The camera's velocity, in its own axes: a step that leads elsewhere than an aircraft can within the time
/// between two pairs is none. It may be a period of a pattern too long, a match of noise or snow, or the way
/// to the other camera. A Kalman filter with white random acceleration, as for the height.
class VelocityMemory {
 public:
  struct Step {
    double duration = 0;         ///< s
    Eigen::Matrix3d rotation;    ///< of directions, from the pair before
    Eigen::Vector3d way;         ///< m, in the camera's axes now
    Eigen::Matrix3d covariance;  ///< m^2
    double stamp_variance = 0;   ///< of the duration, over its square
  };
  struct Innovation {
    Eigen::Vector3d difference;  ///< m/s
    Eigen::Matrix3d covariance;  ///< m^2/s^2
  };
  /// Carries the velocity on and compares. None before three steps in a row have agreed.
  std::optional<Innovation> follow(const Step& step);
  /// After follow(). A step that does not agree leaves the velocity as it was, but for what the aircraft may
  /// have gained or lost since. Before three have agreed the new one is as good as the old one.
  void learn(const Step& step, bool agrees);
  /// A pair that tells nothing of the motion. duration: s.
  void skip(double duration);
  /// s since the last step that did not agree.
  double sinceContradiction() const { return since_contradiction_; }

 private:
  void restart(const Step& step);
  /// Over a time of which no turn is known.
  void carryOn(double duration);
  Eigen::Matrix3d lasting() const;

  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();       // m^2/s^2
  Eigen::Vector3d velocity_before_ = Eigen::Vector3d::Zero();  // before the last step
  Eigen::Matrix3d covariance_before_ = Eigen::Matrix3d::Zero();
  int agreements_ = 0;       // in a row, up to three
  double contradicted_ = 0;  // s, since one agreed
  double since_contradiction_ = std::numeric_limits<double>::infinity();
};

}  // namespace uav_landing
