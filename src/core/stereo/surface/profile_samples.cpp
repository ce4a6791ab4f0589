#include "stereo/surface/profile_samples.h"

#include <algorithm>
#include <cmath>

#include "estimation/robust.h"
#include "kernels/lanes/lanes.h"
#include "kernels/samples/surface_places.h"

namespace uav_landing {
namespace {

// With a smaller disparity (pixels) the distance is unknown.
constexpr double kLeastDisparity = 0.3;

}  // namespace

ProfileSamples::ProfileSamples(const StereoRig& rig, const std::vector<DisparitySample>& samples)
    : fb_(rig.fb()), top_(rig.size.height), count_(samples.size()), flattened_(samples) {
  for (std::vector<double>* column : {&x_, &y_, &disparity_, &by_plane_, &expected_, &reaches_})
    column->resize(wholeDoubleLanes(count_));
  for (size_t i = 0; i < count_; ++i) {
    const Eigen::Vector3d ray = rig.ray(samples[i].u, samples[i].v);
    x_[i] = ray.x();
    y_[i] = ray.y();
    disparity_[i] = samples[i].disparity;
    top_ = std::min(top_, samples[i].v);
  }
  flat_ = disparity_;
}

void ProfileSamples::findPlaces(const GroundPlane& plane) {
  const Eigen::Vector3d n = plane.normal(), g = plane.g;
  const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
  placeOnSurface({g.x(), g.y(), g.z()}, {forward.x(), forward.y(), forward.z()}, fb_, kLeastDisparity,
                 {x_.data(), y_.data(), disparity_.data(), flat_.data(), by_plane_.data(), expected_.data(),
                  reaches_.data(), x_.size()});
}

void ProfileSamples::calmDown(const PlaneFit& fit) {
  std::vector<double> ratios;
  ratios.reserve(count_);
  for (size_t i = 0; i < count_; ++i)
    if (fit.agrees[i]) ratios.push_back(std::abs(flat_[i] - by_plane_[i]) / flattened_[i].stddev);
  if (ratios.empty()) return;
  const double factor = std::min(1.0, robustStddev(ratios));
  for (DisparitySample& sample : flattened_) sample.stddev *= factor;
}

ProfileSums ProfileSamples::sums(const PlaneFit& fit, double noise) const {
  const double largest =
      *std::max_element(expected_.begin(), expected_.begin() + static_cast<std::ptrdiff_t>(count_));
  ProfileSums sums;
  Eigen::Matrix3d to_plane = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < count_; ++i) {
    if (!fit.agrees[i]) continue;
    const DisparitySample& sample = flattened_[i];
    const double information = 1 / (sample.stddev * sample.stddev * noise);
    const double y = information * (disparity_[i] - by_plane_[i]);
    const Eigen::Vector3d a(fb_ * x_[i], fb_ * y_[i], fb_), weighted = information * a;
    to_plane += weighted * a.transpose();
    right += a * y;
    const int place = static_cast<int>(kProfileBins * std::sqrt(expected_[i] / largest));
    ProfileBin& bin = sums.bins[std::min(place, kProfileBins - 1)];
    bin.information += information;
    bin.expected += information * expected_[i];
    bin.reach += information * reaches_[i];
    bin.v += information * sample.v;
    bin.y += y;
    bin.a += weighted;
  }
  sums.information = to_plane;
  sums.right = right;
  return sums;
}

}  // namespace uav_landing
