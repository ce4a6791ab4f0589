#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>

#include "motion/matching/camera_motion.h"

namespace uav_landing {

/// Velocities of the camera at both ends of a step, each in the frame and in units of the height there.
struct StepEnds {
  RowMotion then, now;
};

/// Tells how the camera turns at the stamps of its images, from its rotations over the last frame steps. A
/// rolling shutter needs these rates, and steps tell their means.
///
/// A polynomial goes through the sum of the turns at the last stamps. Its derivative is the rate. Usually its
/// degree is 2: the turn gets faster or slower evenly. In gusts it may be 3, where that would have served far
/// better at the last stamps. The claim is the error that the degree had there.
class TurnHistory {
 public:
  /// Velocities in the step that follows. duration: s. height_then: in heights now.
  StepEnds ends(const CameraMotion& step, double duration, double height_then) const;
  /// Covariance of the error of the rate at the end of the step, minus that at its beginning, (rad/s)^2. It
  /// is 0 in the first step, as nothing tells how far that is from even.
  Eigen::Matrix3d doubt(double duration) const;
  void add(const CameraMotion& step, double duration);
  /// Call it when the next step does not begin where the last one ended. The errors so far still count.
  void interrupt();

 private:
  static constexpr int kMostDegree = 3;
  struct Turned {
    double time;          // s since the first step
    Eigen::Vector3d sum;  // of the turns, rad
  };
  // Squared errors that the rates of one degree had at the last stamps. Errors are divided by what a jerk of
  // 1 rad/s^3 makes them, so that steps of other durations can be claimed.
  struct Scatter {
    int count = 0;
    double weight = 0;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& error);
    bool isTelling() const { return count >= 3; }
    Eigen::Matrix3d mean() const { return sum / weight; }
  };

  int bestDegree() const;
  double lastDuration() const;
  double errorByJerk(double duration) const;
  StepEnds turnBy(int degree, double duration, const Eigen::Vector3d& turn) const;

  std::deque<Turned> turned_ = {{0, Eigen::Vector3d::Zero()}};  // at the last stamps, oldest first
  std::array<Scatter, kMostDegree + 1> scatters_;               // by the degree
  double weight_of_usual_ = 1;                                  // beside the scatter, see kTurnJerk
  std::array<Eigen::Vector3d, kMostDegree + 1> rates_{};        // at the last stamp, by the degree
};

}  // namespace uav_landing
