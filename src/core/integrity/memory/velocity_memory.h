#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace uav_landing {

/// The camera's velocity in its own axes. A step is wrong if an aircraft cannot fly it between two pairs. It
/// may be one period of a pattern too long, a match of noise or snow, or lead to the other camera. This is a
/// Kalman filter with white random acceleration, as for the height.
class VelocityMemory {
 public:
  struct Step {
    double duration = 0;         ///< s
    Eigen::Matrix3d rotation;    ///< rotates directions from the pair before to this one
    Eigen::Vector3d way;         ///< m, in the camera's axes now
    Eigen::Matrix3d covariance;  ///< m^2
    double stamp_variance = 0;   ///< of the duration, over its square
  };
  struct Innovation {
    Eigen::Vector3d difference;  ///< m/s
    Eigen::Matrix3d covariance;  ///< m^2/s^2
  };
  /// Predicts the velocity and compares the step with it. There is no result before three steps in a row have
  /// agreed.
  std::optional<Innovation> follow(const Step& step);
  /// Call it after follow(). A step that does not agree leaves the velocity as it was, and adds the variance
  /// of what the aircraft may have accelerated since. Before three steps have agreed, a new one that
  /// disagrees replaces the old one.
  void learn(const Step& step, bool agrees);
  /// A pair without a motion. duration: s.
  void skip(double duration);
  /// Time since the last step that did not agree, s.
  double sinceContradiction() const { return since_contradiction_; }
  /// Duration of the steps that have agreed since then, s.
  double agreed() const { return agreed_; }

 private:
  void restart(const Step& step);
  /// Predicts over a time with an unknown rotation.
  void carryOn(double duration);
  Eigen::Matrix3d lasting() const;

  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();       // m^2/s^2
  Eigen::Vector3d velocity_before_ = Eigen::Vector3d::Zero();  // before the last step
  Eigen::Matrix3d covariance_before_ = Eigen::Matrix3d::Zero();
  int agreements_ = 0;       // steps in a row that agreed, up to three
  double contradicted_ = 0;  // s since the last step that agreed; 0 when the last one did
  double since_contradiction_ = std::numeric_limits<double>::infinity();
  double agreed_ = std::numeric_limits<double>::infinity();
};

}  // namespace uav_landing
