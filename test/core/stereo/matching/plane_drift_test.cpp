#include "stereo/matching/plane_drift.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "stereo/matching/shift_model.h"
#include "support/rolling_camera.h"

namespace uav_landing {
namespace {

constexpr double kReadout = 0.03;  // s

struct Scene {
  StereoRig rig = test::makeRig(640, 480, 1);
  RowTimes times{test::calibrationOf(rig), {kReadout, 0}};
  PlaneVector g{planeAt(0)};
  PlaneDrift drift{planeRate(g, test::motionAt(0)), &times};

  static Eigen::Vector3d planeAt(double t) {
    const test::Pose pose = test::movingPose(t);
    return pose.down() / pose.height();
  }
  double seen(double u, double v) const { return rig.fb() * planeAt(times.at(u, v)).dot(rig.ray(u, v)); }
  std::vector<DisparitySample> samples() const {
    std::vector<DisparitySample> samples;
    for (double u = 20; u < 640; u += 60)
      for (double v = 260; v < 480; v += 30) samples.push_back({u, v, 0.1, seen(u, v), {seen(u, v) + 7}});
    return samples;
  }
  Eigen::Vector3d fitted(const std::vector<DisparitySample>& samples) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const DisparitySample& sample : samples) {
      const Eigen::Vector3d row = rig.fb() * rig.ray(sample.u, sample.v);
      information += row * row.transpose();
      right += row * sample.disparity;
    }
    return information.ldlt().solve(right);
  }
};

TEST(PlaneDrift, LeadsTheDisparitiesOfRowsToThePlaneAtTheStamp) {
  const Scene scene;
  std::vector<DisparitySample> samples = scene.samples();
  const Eigen::Vector3d& g = scene.g;
  EXPECT_GT((scene.fitted(samples) - g).norm(), 5e-3 * g.norm()) << "the shutter must matter";
  carryToStamp(scene.rig, scene.drift, samples);
  EXPECT_LT((scene.fitted(samples) - g).norm(), 2e-4 * g.norm());
  for (const DisparitySample& sample : samples)
    EXPECT_NEAR(sample.others.front(), sample.disparity + 7, 1e-9);
}

TEST(PlaneDrift, TakesTheTimeOfEachPixelOfAPortraitCamera) {
  const Scene scene;
  const RowTimes columns(test::calibrationOf(scene.rig), {kReadout, 0, RowDirection::kColumns});
  std::vector<DisparitySample> samples = scene.samples();
  carryToStamp(scene.rig, {scene.drift.rate, &columns}, samples);
  for (const DisparitySample& sample : samples) {
    const double time = (sample.u + 0.5) / 640 * kReadout;
    const double added = time * scene.rig.fb() * scene.drift.rate.dot(scene.rig.ray(sample.u, sample.v));
    EXPECT_NEAR(sample.disparity, scene.seen(sample.u, sample.v) - added, 1e-6);
  }
}

TEST(PlaneDrift, OfRowsThatAreExposedAtOnceIsNone) {
  const Scene scene;
  std::vector<DisparitySample> samples = scene.samples();
  const RowTimes at_once;
  carryToStamp(scene.rig, {scene.drift.rate, &at_once}, samples);
  carryToStamp(scene.rig, {}, samples);
  for (const DisparitySample& sample : samples) EXPECT_EQ(sample.disparity, scene.seen(sample.u, sample.v));
  EXPECT_TRUE(planeByRate(scene.rig, {}, samples, std::vector<char>(samples.size(), 1)).isZero(0));
}

TEST(PlaneByRate, IsTheDerivativeOfTheFit) {
  const Scene scene;
  const std::vector<DisparitySample> raw = scene.samples();
  const auto planeWith = [&](const Eigen::Vector3d& rate) {
    std::vector<DisparitySample> samples = raw;
    carryToStamp(scene.rig, {rate, &scene.times}, samples);
    return scene.fitted(samples);
  };
  const Eigen::Matrix3d by_rate = planeByRate(scene.rig, scene.drift, raw, std::vector<char>(raw.size(), 1));
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d change = 0.1 * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d moved = planeWith(scene.drift.rate + change) - planeWith(scene.drift.rate);
    EXPECT_LT((by_rate * change - moved).norm(), 1e-9);
    EXPECT_GT(moved.norm(), 1e-4);
  }
}

TEST(ShiftModel, IsThatOfThePlaneWhenARowIsExposed) {
  const Scene scene;
  const ShiftModel shift(scene.rig, scene.g, scene.drift);
  for (const double u : {50.0, 600.0})
    for (const double v : {260.0, 470.0}) {
      EXPECT_NEAR(shift.at(u, v) - scene.rig.principalOffset(), scene.seen(u, v), 0.05);
      const ShiftModel around = shift.around(u, v);
      EXPECT_NEAR(around.at(u, v), shift.at(u, v), 1e-9);
      EXPECT_NEAR(around.at(u + 1, v), shift.at(u + 1, v), 1e-3);
      EXPECT_NEAR(around.at(u, v + 1), shift.at(u, v + 1), 1e-3);
      EXPECT_NEAR(around.a, shift.at(u + 0.5, v) - shift.at(u - 0.5, v), 1e-4);
    }
}

}  // namespace
}  // namespace uav_landing
