#include "stereo/surface/surface_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "support/ground_renderer.h"

namespace uav_landing {
namespace {

using test::kDegree;

constexpr double kSlopeChange = 0.3 * kDegree;

PlaneLimits makeLimits() { return {30 * kDegree, 30 * kDegree, 20, 0.6}; }

const StereoRig& rig() {
  static const StereoRig rig = test::makeRig(640, 480, 1.0);
  return rig;
}

/// Height of the ground over the distance in front of the camera, m.
using Ground = std::function<double(double)>;

Ground parabola(double radius) {
  return [radius](double x) { return x * x / (2 * radius); };
}

/// Flat up to `from`, then rising ever more steeply until the slope has changed by `degrees`.
Ground bendAhead(double from, double length, double degrees) {
  const double slope = std::tan(degrees * kDegree);
  return [=](double x) {
    const double way = std::max(0.0, x - from), on = std::min(way, length);
    return 0.5 * slope * on * on / length + slope * (way - on);
  };
}

/// Disparities of random pixels by walking along their rays until they are below the ground.
std::vector<DisparitySample> look(const Ground& ground, const test::Pose& pose, double stddev,
                                  std::mt19937& random, int count = 800) {
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::vector<DisparitySample> samples;
  while (static_cast<int>(samples.size()) < count) {
    const double u = uniform(random) * (rig().size.width - 1), v = uniform(random) * (rig().size.height - 1);
    const Eigen::Vector3d ray = pose.worldFromOptical() * rig().ray(u, v);
    const auto over = [&](double depth) {
      return pose.position.z() + depth * ray.z() - ground(depth * ray.x());
    };
    double above = 0, below = 1;
    while (over(below) > 0 && below < 1000) below *= 1.02;
    if (below >= 1000) continue;
    for (int i = 0; i < 60; ++i) (over((above + below) / 2) > 0 ? above : below) = (above + below) / 2;
    samples.push_back({u, v, stddev, {rig().fb() / below + stddev * normal(random)}});
  }
  return samples;
}

struct Fits {
  PlaneFit flat;
  SurfaceProfile profile;
};

Fits fit(const std::vector<DisparitySample>& samples, const test::Pose& pose) {
  Expected<PlaneFit> flat =
      refinePlane(rig(), {samples}, PlaneVector(pose.down() / pose.height()), makeLimits());
  if (!flat) throw std::runtime_error(flat.error().message());
  const std::optional<SurfaceProfile> profile =
      fitSurfaceProfile(rig(), {samples}, *flat, makeLimits(), kSlopeChange);
  EXPECT_TRUE(profile);
  return {*flat, *profile};
}

test::Pose poseAt(double height) {
  test::Pose pose;
  pose.position.z() = height;
  pose.pitch = -4 * kDegree;
  pose.roll = 3 * kDegree;
  return pose;
}

TEST(SurfaceProfile, StaysThePlaneOnFlatGround) {
  std::mt19937 random(1);
  for (const double height : {2.0, 10.0, 40.0}) {
    double more = 0;
    constexpr int kRuns = 20;
    for (int run = 0; run < kRuns; ++run) {
      const Fits fits = fit(look(parabola(1e9), poseAt(height), 0.05, random), poseAt(height));
      const double stddev = std::sqrt(fits.flat.plane.heightVariance());
      EXPECT_NEAR(fits.profile.below.height(), fits.flat.plane.height(), 2 * stddev) << height;
      EXPECT_LT(std::abs(fits.profile.curvature), 4 * std::sqrt(fits.profile.curvature_variance));
      more += std::sqrt(fits.profile.below.heightVariance()) / stddev / kRuns;
    }
    EXPECT_LT(more, 1.5) << height;
  }
}

TEST(SurfaceProfile, HeightIsTheClearanceOverSagAndCrest) {
  std::mt19937 random(2);
  for (const double height : {5.0, 10.0, 25.0})
    for (const double radius : {10000.0, -10000.0, 5000.0}) {
      const Fits fits = fit(look(parabola(radius), poseAt(height), 0.05, random), poseAt(height));
      const double flat_error = std::abs(fits.flat.plane.height() - height);
      const double error = std::abs(fits.profile.below.height() - height);
      EXPECT_GT(flat_error, 0.003 * height) << height << " " << radius;
      EXPECT_LT(error, 0.4 * flat_error) << height << " " << radius;
      EXPECT_LT(error, 3 * std::sqrt(fits.profile.below.heightVariance())) << height << " " << radius;
      EXPECT_NEAR(fits.profile.curvature, 1 / radius, 0.5 / std::abs(radius)) << height << " " << radius;
    }
}

TEST(SurfaceProfile, WhatABendFarAheadLeavesOpenIsInTheCovariance) {
  std::mt19937 random(3);
  const test::Pose pose = poseAt(10);
  for (const double degrees : {-1.0, -0.3, 0.3, 1.0}) {
    const SurfaceProfile profile = fit(look(bendAhead(40, 60, degrees), pose, 0.05, random), pose).profile;
    EXPECT_NEAR(profile.below.height(), 10, 2 * std::sqrt(profile.below.heightVariance())) << degrees;
    EXPECT_LT(profile.below.heightVariance(), 0.1 * 0.1) << degrees;
  }
}

/// One vertical curve after the other, each of a length between 50 and 150 m.
class VerticalCurves {
 public:
  /// curvature: 1 sigma, 1/m.
  VerticalCurves(double curvature, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> normal;
    double slope = 0, bend = 0, until = -100 * uniform(random);
    for (double x = 0; x < 1000; x += 1) {
      if (x > until) {
        bend = curvature * normal(random);
        until = std::max(until, 0.0) + 50 + 100 * uniform(random);
      }
      heights_.push_back(heights_.back() + slope + 0.5 * bend);
      slope += bend;
    }
  }
  double operator()(double x) const {
    const double place = std::clamp(x, 0.0, 999.0);
    const size_t i = static_cast<size_t>(place);
    return heights_[i] + (place - static_cast<double>(i)) * (heights_[i + 1] - heights_[i]);
  }

 private:
  std::vector<double> heights_{0};
};

TEST(SurfaceProfile, CovarianceIsTrueOnGroundOfManyVerticalCurves) {
  std::mt19937 random(4);
  constexpr int kRuns = 100;
  int inside = 0;
  double ratio = 0;
  for (int run = 0; run < kRuns; ++run) {
    const VerticalCurves ground(kSlopeChange / 100 * std::pow(4.0, run % 3 - 2), random);  // of all sorts
    const Fits fits = fit(look(ground, poseAt(8), 0.05, random), poseAt(8));
    const double error = fits.profile.below.height() - 8;
    inside += std::abs(error) < 1.96 * std::sqrt(fits.profile.below.heightVariance());
    ratio += error * error / fits.profile.below.heightVariance() / kRuns;
  }
  EXPECT_GE(inside, 88);
  EXPECT_GT(ratio, 0.3) << "it claims too much";
}

TEST(SurfaceProfile, WhatStandsOnTheGroundIsNoBend) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  const test::Pose pose = poseAt(6);
  std::vector<DisparitySample> samples = look(parabola(1e9), pose, 0.05, random);
  for (DisparitySample& sample : samples)
    if (uniform(random) < 0.2) sample.disparity *= 1.05 + 0.95 * uniform(random);
  const Fits fits = fit(samples, pose);
  EXPECT_NEAR(fits.profile.below.height(), 6, 0.02);
}

TEST(SurfaceProfile, NeedsGroundAtDifferentDistances) {
  std::mt19937 random(6);
  const test::Pose pose = poseAt(6);
  std::vector<DisparitySample> samples = look(parabola(1e9), pose, 0.05, random, 20);
  Expected<PlaneFit> flat = refinePlane(rig(), {samples}, PlaneVector(pose.down() / 6), makeLimits());
  ASSERT_TRUE(flat);
  EXPECT_FALSE(fitSurfaceProfile(rig(), {samples}, *flat, makeLimits(), kSlopeChange));
}

}  // namespace
}  // namespace uav_landing
