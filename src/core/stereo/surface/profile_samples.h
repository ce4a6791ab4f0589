#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "stereo/plane/plane_fit.h"

namespace uav_landing {

/// Sums over samples at about the same distance, weighted by their information.
struct ProfileBin {
  double information = 0, expected = 0, reach = 0, v = 0, y = 0;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< derivative of the disparity by the plane
};
constexpr int kProfileBins = 40;

/// Normal equations of a plane, and the bins.
struct ProfileSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::array<ProfileBin, kProfileBins> bins;
};

/// Disparities along a surface that is a plane plus a bend, stored by columns.
class ProfileSamples {
 public:
  ProfileSamples(const StereoRig& rig, const std::vector<DisparitySample>& samples);

  size_t size() const { return count_; }
  /// Highest row of the samples.
  double top() const { return top_; }
  /// The samples without the bend.
  const std::vector<DisparitySample>& flattened() const { return flattened_; }
  /// Disparity of the surface at a sample, and this disparity times the distance along the tangent straight
  /// below.
  double expected(size_t i) const { return expected_[i]; }
  double reach(size_t i) const { return reaches_[i]; }

  /// Finds the places of the samples on the surface after the bend has been subtracted.
  void findPlaces(const GroundPlane& plane);
  /// Subtracts the effect of a bend from a sample's disparity.
  void takeOff(size_t i, double bend) { flattened_[i].disparity = flat_[i] = disparity_[i] - bend; }
  /// Reduces the stddevs of the samples if the bend had enlarged them as noise. fit: made after findPlaces()
  /// with it.
  void calmDown(const PlaneFit& fit);
  /// Sums over the agreeing samples. noise: factor on their variances, because their errors are not
  /// independent. The effect of a kink is linear in the disparity except at the kink, so the middle of a bin
  /// can stand for all of it. Bins are narrower far away, where kinks are close together in disparity.
  ProfileSums sums(const PlaneFit& fit, double noise) const;

 private:
  double fb_, top_;
  size_t count_;
  std::vector<DisparitySample> flattened_;
  // Filled up to whole lanes: rays (z = 1), disparities with and without the bend.
  std::vector<double> x_, y_, disparity_, flat_;
  // Disparity of the plane, and the places on the surface.
  std::vector<double> by_plane_, expected_, reaches_;
};

}  // namespace uav_landing
