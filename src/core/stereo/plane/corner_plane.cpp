#include "stereo/plane/corner_plane.h"

#include <Eigen/LU>
#include <string>

#include "geometry/bias_variance.h"
#include "image/input/image_cells.h"
#include "image/windows/window_overlap.h"
#include "stereo/plane/plane_consensus.h"

namespace uav_landing {
namespace {

// Derivatives of a sample's disparity by the plane vector.
Eigen::Vector3d rowOf(const StereoRig& rig, const DisparitySample& sample) {
  return rig.fb() * rig.ray(sample.u, sample.v);
}

// Covariance of the plane if the errors of the agreeing samples were independent.
Eigen::Matrix3d independentCovariance(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                                      const PlaneFit& fit) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!fit.agrees[i]) continue;
    const Eigen::Vector3d row = rowOf(rig, samples[i]) / samples[i].stddev;
    information += row * row.transpose();
  }
  return information.inverse();
}

// Factor on the noise's variance, because overlapping windows share pixels.
double overlapFactor(const std::vector<DisparitySample>& samples, const PlaneFit& fit, int window) {
  WindowOverlap windows(samples.size());
  for (size_t i = 0; i < samples.size(); ++i)
    if (fit.agrees[i]) windows.add(samples[i].u, samples[i].v, window);
  return windows.factor();
}

}  // namespace

Expected<PlaneFit> fitCorners(const StereoRig& rig, const Disparities& disparities, int corners,
                              const PlaneVector& expected, const PlaneLimits& limits) {
  constexpr int kTrials = 200;
  const std::vector<DisparitySample>& samples = disparities.samples;
  if (static_cast<int>(samples.size()) < limits.min_points) {
    return tl::make_unexpected(
        Failure{corners < limits.min_points ? Reason::kTooFewFeatures : Reason::kTooFewMatches,
                std::to_string(samples.size()) + " matches of " + std::to_string(corners) +
                    " corners, at least " + std::to_string(limits.min_points) + " needed"});
  }
  const std::optional<Consensus> consensus =
      findPlane(rig, samples, limits, {kTrials, true, std::nullopt, expected});
  if (!consensus) {
    return tl::make_unexpected(Failure{
        Reason::kNoPlane, "no plausible ground plane in " + std::to_string(samples.size()) + " matches"});
  }
  return refinePlane(rig, disparities, consensus->g, limits);
}

Eigen::Matrix3d sharedCovariance(const StereoRig& rig, const MatchedCorners& corners, int window,
                                 double bias_stddev) {
  const std::vector<DisparitySample>& samples = corners.matches.samples;
  const PlaneFit& fit = corners.fit;
  const Eigen::Matrix3d independent = independentCovariance(rig, samples, fit);
  ClusterCovariance<3> parts;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!fit.agrees[i]) continue;
    const Eigen::Vector3d row = rowOf(rig, samples[i]);
    const double residual = samples[i].disparity - row.dot(fit.plane.g);
    parts.add(imageCell(rig, samples[i].u, samples[i].v),
              independent * row * (residual / (samples[i].stddev * samples[i].stddev)));
  }
  Eigen::Matrix3d own = fit.plane.covariance;
  own(2, 2) -= biasVariance(rig, bias_stddev);
  return (overlapFactor(samples, fit, window) - 1) * own + parts.shared();
}

}  // namespace uav_landing
