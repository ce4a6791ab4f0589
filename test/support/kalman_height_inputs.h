#pragma once

#include <Eigen/Core>
#include <cmath>

#include "support/degree.h"
#include "uav_landing/stages/kalman_height_stage.h"

namespace uav_landing {
namespace test {

// What the stages before kalman_height say of a pair, without points of the ground.

constexpr double kStep = 0.1;  // s between pairs

/// What stereo says of a plane at this height: 1 sigma of the height is height_stddev.
inline StereoDepthResult stereoAt(double stamp, double height, double pitch = -0.1, double roll = 0.05,
                                  double height_stddev = 0.01) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  const Eigen::Vector3d n(std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll),
                          -std::sin(pitch));
  stereo.plane.g = n / height;
  const double along = height_stddev / (height * height);
  stereo.plane.covariance = along * along * Eigen::Matrix3d::Identity();
  return stereo;
}

inline StereoDepthResult noStereo(double stamp) {
  StereoDepthResult stereo;
  stereo.stamp = stamp;
  stereo.failure = {Reason::kTooFewMatches, "7 of at least 20"};
  return stereo;
}

/// An approach angle of 5 degrees known to 0.1 degrees, without motion or vanishing point.
inline ApproachAngleResult angleAt(double stamp) {
  ApproachAngleResult approach;
  approach.stamp = stamp;
  approach.window.angle = 5 * kDegree;
  approach.window.angle_variance = std::pow(0.1 * kDegree, 2);
  approach.step.angle = 5.2 * kDegree;
  approach.step.angle_variance = std::pow(0.3 * kDegree, 2);
  approach.step.failure = {Reason::kNoMotion, "no step in this test"};
  return approach;
}

/// A straight flight in which nothing turns between the pairs, the rotation known to 0.05 degrees.
inline ApproachAngleResult withoutTurning(double stamp) {
  ApproachAngleResult approach = angleAt(stamp);
  approach.step.failure = {};
  approach.step.duration = kStep;
  approach.step.rotation = Eigen::Vector3d::Zero();
  approach.step.translation_over_height = {0, 0, 0.2};
  approach.step.covariance = std::pow(0.05 * kDegree, 2) * Matrix6d::Identity();
  return approach;
}

/// Feeds the same height from stamp 0 on until the stage believes it; returns the stamp of the next pair.
inline double settle(KalmanHeightStage& stage, double height, int pairs = 20) {
  double stamp = 0;
  for (int i = 0; i < pairs; ++i, stamp += kStep) stage.process(stereoAt(stamp, height), angleAt(stamp));
  return stamp;
}

}  // namespace test
}  // namespace uav_landing
