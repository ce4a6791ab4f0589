#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/ground_renderer.h"
#include "uav_landing/stages/stereo_depth_stage.h"

namespace uav_landing::test {

/// One rig over one ground, and what a stage makes of it that searches within one pair.
struct StereoStageScene {
  static constexpr double kBaseline = 0.65;
  struct Pair {
    cv::Mat left, right;
  };

  StereoRig rig = test::makeRig(320, 240, kBaseline);
  RigModel model = test::makeModel(rig);
  GroundRenderer ground;
  StereoDepthParameters parameters;

  explicit StereoStageScene(unsigned seed, double grain = 0.01) : ground(seed) {
    ground.grain = grain;
    parameters.search_at_once = true;
  }

  Pair render(const Pose& pose, const Exposure& left = {}, const Exposure& right = {}) const {
    return {ground.left(rig, pose, left), ground.right(rig, pose, right)};
  }
  StereoDepthResult first(const Pair& pair) const {
    return StereoDepthStage(model, parameters).process(1, pair.left, pair.right);
  }
};

/// Height, pitch and roll are within 3.5 of the claimed sigmas of the truth, and these are small. A surface
/// is not known to be a plane to better than a thousandth of the height, so a third of that is granted
/// besides.
inline void expectPose(const StereoDepthResult& result, const Pose& truth, const std::string& where) {
  ASSERT_FALSE(result.failure) << where << ": " << result.failure.message();
  const GroundPlane& plane = result.plane;
  const double height_stddev = std::hypot(std::sqrt(plane.heightVariance()), truth.height() / 3000);
  const Eigen::Vector3d n = plane.normal();
  const double pitch_stddev = std::sqrt(pitchVariance(n, plane.normalCovariance()));
  const double roll_stddev = std::sqrt(rollVariance(n, plane.normalCovariance()));
  EXPECT_NEAR(plane.height(), truth.height(), 3.5 * height_stddev) << where;
  EXPECT_NEAR(pitchOf(n), truth.pitch, 3.5 * pitch_stddev) << where;
  EXPECT_NEAR(rollOf(n), truth.roll, 3.5 * roll_stddev) << where;
  EXPECT_LT(height_stddev, 0.005 * truth.height()) << where;
  EXPECT_LT(pitch_stddev, 0.2 * kDegree) << where;
  EXPECT_LT(roll_stddev, 0.2 * kDegree) << where;
}

}  // namespace uav_landing::test
