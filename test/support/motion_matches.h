#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "motion/step/ego_motion.h"
#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace test {

/// Of the matches below.
inline const StereoRig& motionRig() {
  static const StereoRig rig = test::makeRig(640, 480, 1.0);
  return rig;
}

/// Two poses of an approach with drift and rotation in all axes.
struct Step {
  Pose then, now;
  Movement movement;
  Eigen::Vector3d t;  ///< over the height now
  Eigen::Vector3d n;

  static Step make(double pitch_deg = -6) {
    Pose then, now;
    then.position = {-30, 0.5, 6.2};
    then.pitch = pitch_deg * kDegree;
    then.roll = 2 * kDegree;
    now.position = {-28.4, 0.6, 6.0};
    now.pitch = (pitch_deg + 0.7) * kDegree;
    now.roll = 0.5 * kDegree;
    now.yaw = 0.9 * kDegree;
    return Step(then, now);
  }
  Step(const Pose& from, const Pose& to)
      : then(from), now(to), movement(from, to), t(movement.t / to.height()), n(to.down()) {}
};

/// Matches by projecting points of the world into both poses.
class Matcher {
 public:
  Matcher(const Step& step, unsigned seed) : step_(step), random_(seed) {}

  std::vector<TemporalMatch> ground(int count, double noise) {
    std::vector<TemporalMatch> matches;
    while (static_cast<int>(matches.size()) < count) {
      const Eigen::Vector2d pixel = anyPixel();
      const double slope = step_.n.dot(motionRig().ray(pixel.x(), pixel.y()));
      if (slope < 0.02) continue;
      add(pixel, step_.now.height() / slope, noise, true, 0, matches);
    }
    return matches;
  }

  /// Points that stand at random depths; their inverse depth (times height) is known to depth_noise.
  std::vector<TemporalMatch> standing(int count, double noise, double depth_noise) {
    std::vector<TemporalMatch> matches;
    while (static_cast<int>(matches.size()) < count)
      add(anyPixel(), 8 + 40 * uniform_(random_), noise, false, depth_noise, matches);
    return matches;
  }

  /// Moves a share of the matches elsewhere.
  void spoil(std::vector<TemporalMatch>& matches, double share) {
    for (TemporalMatch& match : matches)
      if (uniform_(random_) < share) match.then += 4 * draw() + 30 * Eigen::Vector2d(uniform_(random_), 0);
  }

  /// Finds each elsewhere, as with a warp that is wrong and gradients beside the corner.
  void findByWrongWarps(std::vector<TemporalMatch>& matches, double wrong) {
    for (TemporalMatch& match : matches) {
      Eigen::Matrix2d warp, error;
      warp.col(0) = groundSeenThen(match.now + Eigen::Vector2d::UnitX()) - groundSeenThen(match.now);
      warp.col(1) = groundSeenThen(match.now + Eigen::Vector2d::UnitY()) - groundSeenThen(match.now);
      for (int axis = 0; axis < 2; ++axis) {
        error.col(axis) = wrong * draw();
        match.by_warp[axis] << draw(), draw();
        match.then -= match.by_warp[axis] * error.col(axis);
      }
      match.warp = warp + error;
    }
  }

  Eigen::Vector2d draw() { return {normal_(random_), normal_(random_)}; }

 private:
  Eigen::Vector2d anyPixel() {
    return {uniform_(random_) * (motionRig().size.width - 1),
            uniform_(random_) * (motionRig().size.height - 1)};
  }

  Eigen::Vector2d groundSeenThen(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d ray = motionRig().ray(pixel.x(), pixel.y());
    const Eigen::Vector3d X = step_.now.height() / step_.n.dot(ray) * ray;
    return motionRig().project(
        step_.then.seen(step_.now.worldFromOptical() * X + step_.now.position - step_.then.position));
  }

  void add(const Eigen::Vector2d& pixel, double depth, double noise, bool on_plane, double depth_noise,
           std::vector<TemporalMatch>& matches) {
    const Eigen::Vector3d X = depth * motionRig().ray(pixel.x(), pixel.y());
    const Eigen::Vector3d world = step_.now.worldFromOptical() * X + step_.now.position;
    const Eigen::Vector3d before = step_.then.seen(world - step_.then.position);
    if (!(before.z() > 0.1)) return;
    TemporalMatch match;
    match.now = pixel;
    match.then = motionRig().project(before) + noise * draw();
    match.covariance = std::pow(std::max(noise, 0.01), 2) * Eigen::Matrix2d::Identity();
    match.on_plane = on_plane;
    match.inverse_depth = step_.now.height() / depth + depth_noise * normal_(random_);
    match.inverse_depth_stddev = depth_noise;
    matches.push_back(match);
  }

  const Step& step_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

/// Covariance of a normal that is known to this, rad.
inline Eigen::Matrix3d across(const Eigen::Vector3d& n, double stddev) {
  return stddev * stddev * (Eigen::Matrix3d::Identity() - n * n.transpose());
}

inline Expected<MotionEstimate> estimate(const std::vector<TemporalMatch>& matches, const Eigen::Vector3d& n,
                                         double stddev, const CameraMotion& start = {}) {
  return estimateMotion(motionRig(), matches, {start, {n, across(n, stddev)}}, 15);
}

}  // namespace test
}  // namespace uav_landing
