#include "rig/pair_skew.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "support/rigs.h"

namespace uav_landing {
namespace {

StereoRig makeRig() { return test::rigOf({640, 480}, 600, {320, 240}, 320, 0.8); }

const Eigen::Vector3d kTruePlane = Eigen::Vector3d(0.02, 0.99, 0.06).normalized() / 12;

/// Ground points as seen by the left camera and, `skew` later, by the right camera of the moved rig: exact
/// projections, the points turned and shifted the other way than the camera.
std::vector<StereoDepthResult::Point> seePoints(const StereoRig& rig, const CameraRates& rates, double skew) {
  const Eigen::Vector3d turned = rates.angular_velocity * skew;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(-turned.norm(), turned.norm() > 0 ? turned.normalized() : Eigen::Vector3d::UnitX())
          .toRotationMatrix();
  std::vector<StereoDepthResult::Point> points;
  for (double u = 20; u < 640; u += 40) {
    for (double v = 300; v < 480; v += 20) {
      const Eigen::Vector3d ray((u - 320) / 600, (v - 240) / 600, 1);
      const Eigen::Vector3d X = ray / kTruePlane.dot(ray);
      const Eigen::Vector3d moved = R * (X - rates.velocity * skew);
      StereoDepthResult::Point point;
      point.u = u;
      point.v = v;
      point.disparity = u - (600 * (moved.x() - rig.baseline) / moved.z() + 320);
      point.on_plane = true;
      points.push_back(point);
    }
  }
  return points;
}

Eigen::Vector3d fitPlane(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points) {
  Eigen::MatrixXd rays(points.size(), 3);
  Eigen::VectorXd inverse_depths(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rays.row(i) = rig.ray(points[i].u, points[i].v).transpose();
    inverse_depths[i] = points[i].disparity / (rig.fx * rig.baseline);
  }
  return rays.colPivHouseholderQr().solve(inverse_depths);
}

double meanInverseDepth(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points) {
  double sum = 0;
  for (const auto& point : points) sum += point.disparity / rig.fb();
  return sum / points.size();
}

TEST(PairSkew, PutsTheRightCameraWhereItIsByThen) {
  const StereoRig rig = makeRig();
  StereoDepthResult stereo;
  stereo.plane.g = kTruePlane;
  stereo.skew = 0.004;
  ApproachAngleResult::Motion step;
  step.duration = 0.05;
  step.translation_over_height = Eigen::Vector3d(0.02, 0.1, 1.0) / 12;  // 20 m/s ahead, 2 m/s down
  const BaselineDirection direction = baselineOfSkew(rig, stereo, step);
  EXPECT_NEAR(direction.t.x(), 2 * 0.004 / 0.8, 1e-3);
  EXPECT_NEAR(direction.t.y(), 20 * 0.004 / 0.8, 1e-3);
  stereo.skew = 0;
  EXPECT_EQ(baselineOfSkew(rig, stereo, step).t, Eigen::Vector2d(0, 0));
  EXPECT_EQ(baselineOfSkew(rig, stereo, step).covariance, Eigen::Matrix2d::Zero());
}

TEST(PairSkew, PredictsHowThePlaneOfAMovedRigIsWrong) {
  const StereoRig rig = makeRig();
  const double skew = 0.002;
  const std::vector<CameraRates> movements = {
      {{3, 0, 0}, {0, 0, 0}}, {{0, 0, 20}, {0, 0, 0}}, {{0, 0, 0}, {0, 0.4, 0}}, {{0, 0, 0}, {0, 0, 0.4}}};
  for (const CameraRates& rates : movements) {
    const auto points = seePoints(rig, rates, skew);
    const Eigen::Vector3d error = fitPlane(rig, points) - kTruePlane;
    const Eigen::Vector3d predicted =
        planeErrorOfSkew(rig, PlaneVector(kTruePlane), meanInverseDepth(rig, points), rates, skew);
    EXPECT_LT((predicted - error).norm(), 0.3 * error.norm())
        << "error " << error.transpose() << " predicted " << predicted.transpose();
  }
}

TEST(PairSkew, EnlargesTheCovarianceByTheErrorOfTheKnownMotion) {
  const StereoRig rig = makeRig();
  const CameraRates rates{{1, 0.5, 20}, {0.02, 0.1, 0.05}};
  StereoDepthResult stereo;
  stereo.points = seePoints(rig, rates, 0.003);
  stereo.plane.g = fitPlane(rig, stereo.points);
  stereo.plane.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  ApproachAngleResult::Motion step;
  step.duration = 0.1;
  step.rotation = -rates.angular_velocity * step.duration;
  step.translation_over_height = rates.velocity * step.duration / stereo.plane.height();

  stereo.skew = 0;
  EXPECT_EQ(withSkew(rig, stereo, step).covariance, stereo.plane.covariance);
  StereoDepthResult without_plane;
  without_plane.skew = 0.01;
  EXPECT_FALSE(withSkew(rig, without_plane, step).valid());

  stereo.skew = 0.003;
  const double error = stereo.plane.height() - 12;
  EXPECT_GT(std::abs(error), 0.05);
  const double claimed = std::sqrt(withSkew(rig, stereo, step).heightVariance());
  EXPECT_GT(claimed, 0.6 * std::abs(error));
  EXPECT_LT(claimed, 1.7 * std::abs(error));

  step.failure = {Reason::kNotYet, ""};
  EXPECT_GT(std::sqrt(withSkew(rig, stereo, step).heightVariance()), std::abs(error));
}

TEST(PairSkew, ClaimsOfTheBaselineAFifthOfTheWayOrWhatASmallAircraftMoves) {
  const StereoRig rig = makeRig();
  StereoDepthResult stereo;
  stereo.plane.g = kTruePlane;
  stereo.skew = -0.004;
  ApproachAngleResult::Motion step;
  step.duration = 0.05;
  step.translation_over_height = Eigen::Vector3d(0.02, 0.1, 1.0) / 12;
  // 8 cm forward and 0.8 cm down on a baseline of 0.8 m; the way back, as the right image is the first.
  const BaselineDirection known = baselineOfSkew(rig, stereo, step);
  EXPECT_NEAR(known.t.y(), -0.1, 1e-3);
  const double stddev = 0.2 * std::hypot(0.1, 0.01);
  EXPECT_NEAR(std::sqrt(known.covariance(0, 0)), stddev, 1e-3 * stddev);
  EXPECT_NEAR(std::sqrt(known.covariance(1, 1)), stddev, 1e-3 * stddev);
  EXPECT_EQ(known.covariance(0, 1), 0);
  // 2 m/s down or up, 20 m/s forward.
  step.failure = {Reason::kNotYet, ""};
  const BaselineDirection unknown = baselineOfSkew(rig, stereo, step);
  EXPECT_EQ(unknown.t, Eigen::Vector2d(0, 0));
  EXPECT_NEAR(std::sqrt(unknown.covariance(0, 0)), 2 * 0.004 / 0.8, 1e-12);
  EXPECT_NEAR(std::sqrt(unknown.covariance(1, 1)), 20 * 0.004 / 0.8, 1e-12);
}

TEST(PairSkew, PointsOffThePlaneDoNotTellHowFarTheGroundIs) {
  const StereoRig rig = makeRig();
  StereoDepthResult stereo;
  stereo.points = seePoints(rig, {{0, 0, 20}, {0, 0, 0}}, 0.003);
  stereo.plane.g = fitPlane(rig, stereo.points);
  stereo.plane.covariance = 1e-12 * Eigen::Matrix3d::Identity();
  stereo.skew = 0.003;
  ApproachAngleResult::Motion step;
  step.failure = {Reason::kNotYet, ""};
  const Eigen::Matrix3d with_ground = withSkew(rig, stereo, step).covariance;
  for (int i = 0; i < 50; ++i) stereo.points.push_back({100, 100, 400, 0.1, false});
  EXPECT_EQ(withSkew(rig, stereo, step).covariance, with_ground);
}

}  // namespace
}  // namespace uav_landing
