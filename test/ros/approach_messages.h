#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "conversions.h"
#include "uav_landing/geometry/ground_plane.h"

namespace uav_landing {

/// What stereo_depth and approach_angle say, without noise, of a straight approach over a level runway.
struct ApproachMessages {
  static constexpr double kStep = 0.05;                    // s between pairs
  static constexpr double kSpeed = 20, kSink = 1;          // m/s
  static constexpr double kStartHeight = 20, kWidth = 30;  // m
  static constexpr double kPitch = -0.06, kRoll = 0.02;    // rad
  static constexpr double kSmall = 0.002;                  // 1 sigma of directions, rad

  StereoRig rig;
  StereoDepth stereo;
  ApproachAngle approach;

  ApproachMessages() {
    rig.size = {640, 480};
    rig.fx = rig.fy = 500;
    rig.cx = rig.cx_right = 320;
    rig.cy = 240;
    rig.baseline = 1.0;
  }

  double height(int pair) const { return kStartHeight - kSink * kStep * pair; }
  static double angle() { return std::atan2(kSink, kSpeed); }

  /// Makes the messages of this pair.
  void make(int pair) {
    std_msgs::Header header;
    header.stamp = ros::Time(100 + kStep * pair);
    stereo = toMessage(stereoAt(pair), header, 1.0);
    approach = toMessage(approachAt(pair), header, 1.0);
  }

 private:
  static Eigen::Matrix3d directionCovariance(const Eigen::Vector3d& direction) {
    return kSmall * kSmall * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
  }

  StereoDepthResult stereoAt(int pair) const {
    const double h = height(pair);
    StereoDepthResult result;
    result.corners = 80;
    result.plane.g = normalFromPitchRoll(kPitch, kRoll) / h;
    result.disparity_bias_stddev = 0.02;
    result.row_bias_stddev = 0.03;
    result.plane.covariance = std::pow(kSmall / h, 2) * Eigen::Matrix3d::Identity();
    result.plane.covariance(2, 2) += std::pow(result.disparity_bias_stddev / rig.fb(), 2);
    for (int v = 280; v < 480; v += 40)
      for (int u = 20; u < 640; u += 60)
        result.points.push_back({1.0 * u, 1.0 * v, result.plane.disparity(rig, u, v), 0.1, true});
    result.residual_stddev = 0.1;
    result.surface_variance = 1e-6 * h * h;
    result.vertical_rotation.w.setZero();
    result.vertical_rotation.covariance = Eigen::Vector3d(1e-8, 1e-4, 1e-8).asDiagonal();
    result.vertical_rotation.count = 50;
    result.baseline_direction.t.setZero();
    result.baseline_direction.covariance = 1e-4 * Eigen::Matrix2d::Identity();
    return result;
  }

  ApproachAngleResult approachAt(int pair) const {
    const double h = height(pair);
    ApproachAngleResult result;
    result.n = normalFromPitchRoll(kPitch, kRoll);
    result.n_covariance = directionCovariance(result.n);
    result.n_vp = result.n;
    result.n_vp_covariance = result.n_covariance;
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    result.vanishing_direction = (z - result.n.z() * result.n).normalized();
    result.vanishing_covariance = directionCovariance(result.vanishing_direction);
    result.other_runway_probability = 0;
    for (ApproachAngleResult::View* view : {&result.left, &result.right}) {
      view->lines = {{{100, 470}, {300, 230}, true}, {{540, 470}, {340, 230}, true}};
      view->vanishing_direction = result.vanishing_direction;
      view->vanishing_covariance = result.vanishing_covariance;
    }
    result.step = motion(result, kStep, h);
    result.window = motion(result, 10 * kStep, h);
    result.foe = rig.project(result.step.translation_over_height);
    result.foe_covariance = Eigen::Matrix2d::Identity();
    result.runway.y = 1 / h;
    result.runway.width = kWidth / h;
    result.runway.x = (-300 + kSpeed * kStep * pair) / h;
    result.runway.y_variance = result.runway.width_variance = 1e-4;
    result.runway.x_variance = 1e-2;
    result.imu.failure = {};
    result.imu.normal = result.n;
    result.imu.normal_covariance = 100 * directionCovariance(result.n);
    result.imu.duration = kStep;
    result.imu.rotation.setZero();
    result.imu.rotation_covariance = 1e-7 * Eigen::Matrix3d::Identity();
    return result;
  }

  static ApproachAngleResult::Motion motion(const ApproachAngleResult& result, double duration, double h) {
    ApproachAngleResult::Motion motion;
    motion.duration = duration;
    motion.matches = motion.inliers = 60;
    motion.rotation.setZero();
    motion.translation_over_height = duration * (kSpeed * result.vanishing_direction + kSink * result.n) / h;
    motion.covariance = 1e-7 * Matrix6d::Identity();
    motion.angle = angle();
    motion.angle_variance = kSmall * kSmall;
    motion.normal = result.n;
    motion.normal_covariance = directionCovariance(result.n);
    return motion;
  }
};

}  // namespace uav_landing
