#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "stereo/plane/plane_fit.h"

namespace uav_landing {

/// Sums over samples at about the same distance, by their information.
struct ProfileBin {
  double information = 0, expected = 0, reach = 0, v = 0, y = 0;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< disparity by plane
};
constexpr int kProfileBins = 40;

/// Of the normal equations of a plane.
struct ProfileSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::array<ProfileBin, kProfileBins> bins;
};

/// Disparities along a surface that is a plane but for a bend, by columns.
class ProfileSamples {
 public:
  ProfileSamples(const StereoRig& rig, const std::vector<DisparitySample>& samples);

  size_t size() const { return count_; }
  /// Highest row of them.
  double top() const { return top_; }
  /// The samples without the bend.
  const std::vector<DisparitySample>& flattened() const { return flattened_; }
  /// Disparity of the surface where a sample is, and that times the distance along the tangent straight
  /// below.
  double expected(size_t i) const { return expected_[i]; }
  double reach(size_t i) const { return reaches_[i]; }

  /// Where the samples are on the surface, of which the bend has been taken off.
  void findPlaces(const GroundPlane& plane);
  /// Takes off a sample's disparity what a bend does to it.
  void takeOff(size_t i, double bend) { flattened_[i].disparity = flat_[i] = disparity_[i] - bend; }
  /// Stddevs of the samples that take a bend for noise are made smaller. fit: after findPlaces() by it.
  void calmDown(const PlaneFit& fit);
  /// Of the samples that agree. noise: by which the samples' errors count more than as independent ones of
  /// their stddevs, as a factor on variances. What kinks do is linear in the disparity, but at the kinks, so
  /// that the middle of a bin stands for all of it; the bins are narrower far away, where the kinks are close
  /// in disparity.
  ProfileSums sums(const PlaneFit& fit, double noise) const;

 private:
  double fb_, top_;
  size_t count_;
  std::vector<DisparitySample> flattened_;
  // Filled up to whole lanes: rays (z = 1), disparities with the bend and without.
  std::vector<double> x_, y_, disparity_, flat_;
  // Disparity of the plane, and the places.
  std::vector<double> by_plane_, expected_, reaches_;
};

}  // namespace uav_landing
