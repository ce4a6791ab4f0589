#pragma once

#include <cmath>
#include <vector>

#include "stereo/matching/stereo_level.h"
#include "stereo/photometric/block_disparity.h"
#include "support/ground_renderer.h"
#include "support/rigs.h"

namespace uav_landing {
namespace test {

/// A rig over textured ground, and what its cameras see of it.
struct GroundPair {
  StereoRig rig;
  RigModel model = makeModel(rig);
  RigRotation rows = levelRows();
  GroundRenderer ground;
  Pose pose;
  PlaneVector truth{pose.down() / pose.height()};
  cv::Mat left, right;

  /// height: m; pitch, roll: deg.
  GroundPair(cv::Size size, unsigned seed, double height, double pitch, double roll)
      : rig(makeRig(size.width, size.height, 0.65)), ground(seed), pose(makePose(height, pitch, roll)) {}

  void render(const Exposure& of_left = {}, const Exposure& of_right = {}) {
    left = ground.left(rig, pose, of_left);
    right = ground.right(rig, pose, of_right);
  }
  StereoLevel level() const { return reduceLevel(model, 1, 4); }
  /// The true plane with its disparities off by some pixels and a share.
  PlaneVector off(double pixels, double share = 0) const {
    return PlaneVector(truth.vector() * (1 + share) + Eigen::Vector3d(0, 0, pixels / rig.fb()));
  }

  struct Mean {
    double error = 0, stddev = 0;  // pixels
  };
  /// Weighted mean of the errors of disparities.
  Mean mean(const std::vector<BlockDisparity>& disparities) const {
    double sum = 0, weights = 0;
    for (const BlockDisparity& found : disparities) {
      if (!found.alike) continue;
      const DisparitySample& sample = found.sample;
      const double weight = 1 / (sample.stddev * sample.stddev);
      sum += weight * (sample.disparity - truth.disparity(rig, sample.u, sample.v));
      weights += weight;
    }
    return {sum / weights, 1 / std::sqrt(weights)};
  }
};

}  // namespace test
}  // namespace uav_landing
