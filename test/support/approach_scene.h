#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/ground_renderer.h"
#include "uav_landing/stages/approach_angle_stage.h"

namespace uav_landing::test {

constexpr double kPeriod = 0.1;  // s
/// Share of the height and rad, 1 sigma, of what stereo says.
constexpr double kHeightShare = 1e-3, kNormalStddev = 5e-4;

/// One rig over one ground with two painted lines; what stereo says of it is the truth with a small
/// covariance.
struct ApproachScene {
  StereoRig rig = makeRig(320, 240, 0.65);
  RigModel model = makeModel(rig);
  GroundRenderer ground;
  ApproachAngleParameters parameters;

  explicit ApproachScene(unsigned seed) : ground(seed) {
    ground.line_offset = 1.0;
    ground.line_width = 0.12;
    parameters.search_at_once = true;  // tests are of a pair or two
  }

  StereoDepthResult stereo(const Pose& pose, double stamp) const {
    StereoDepthResult result;
    result.stamp = stamp;
    result.plane = exactPlane(pose, kHeightShare, kNormalStddev);
    for (int v = rig.size.height * 45 / 100; v < rig.size.height - 10; v += 7)
      for (int u = 10; u < rig.size.width - 10; u += 9) {
        const double disparity = result.plane.disparity(rig, u, v);
        if (disparity > 1) result.points.push_back({double(u), double(v), disparity, 0.05, true});
      }
    return result;
  }

  std::vector<ApproachAngleResult> run(const std::function<Pose(double)>& path, int frames) const {
    ApproachAngleStage stage(model, parameters);
    std::vector<ApproachAngleResult> results;
    for (int i = 0; i < frames; ++i) {
      const Pose pose = path(i * kPeriod);
      results.push_back(stage.process(i * kPeriod, ground.left(rig, pose), ground.right(rig, pose),
                                      stereo(pose, i * kPeriod)));
    }
    return results;
  }
};

/// At the origin.
inline Pose attitude(double pitch_deg, double roll_deg, double yaw_deg) {
  Pose pose;
  pose.pitch = pitch_deg * kDegree;
  pose.roll = roll_deg * kDegree;
  pose.yaw = yaw_deg * kDegree;
  return pose;
}

/// Straight path from (x, 0, height): angle below the horizontal, drift to the left.
inline std::function<Pose(double)> straight(const Pose& start, double height, double speed, double angle_deg,
                                            double track_deg = 0) {
  return [=](double t) {
    Pose pose = start;
    const double angle = angle_deg * kDegree, track = track_deg * kDegree;
    pose.position = Eigen::Vector3d(0, 0, height) + speed * t *
                                                        Eigen::Vector3d(std::cos(angle) * std::cos(track),
                                                                        std::cos(angle) * std::sin(track),
                                                                        -std::sin(angle));
    return pose;
  };
}

/// A motion is the one that the poses say, within what it claims; of the length of t, a thousandth is granted
/// for errors that neighbouring matches have in common.
inline void expectMotion(const ApproachAngleResult::Motion& motion, const Movement& truth, double height,
                         const std::string& what) {
  ASSERT_FALSE(motion.failure) << what << ": " << motion.failure.message();
  const double stddev = std::sqrt(motion.angle_variance);
  EXPECT_NEAR(motion.angle, truth.angle, 3.5 * stddev) << what;
  EXPECT_LT(stddev, 0.6 * kDegree) << what;
  const Eigen::Vector3d t = truth.t / height;
  const Eigen::AngleAxisd turn(truth.R);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(motion.translation_over_height[i], t[i],
                4 * std::hypot(std::sqrt(motion.covariance(3 + i, 3 + i)), 1e-3 * t.norm()))
        << what;
    EXPECT_NEAR(motion.rotation[i], turn.angle() * turn.axis()[i], 4 * std::sqrt(motion.covariance(i, i)))
        << what;
  }
}

}  // namespace uav_landing::test
