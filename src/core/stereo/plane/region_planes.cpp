#include "stereo/plane/region_planes.h"

#include <algorithm>

#include "kernels/lanes/order_statistic.h"
#include "stereo/plane/plane_fit.h"

namespace uav_landing {
namespace {

constexpr int kFewest = 10;        // points that a plane needs
constexpr double kTolerance = 1;   // pixels, see PlaneLimits
constexpr double kMaxAngle = 1.0;  // rad; the previous stage has checked the attitude already

/// Borders of the strips and halves: disparities far and near, column middle, pixels.
struct Borders {
  double far = 0, near = 0, middle = 0;
};

double quantile(const std::vector<double>& values, double share) {
  const auto rank = static_cast<size_t>(share * static_cast<double>(values.size() - 1));
  return orderStatistic(values.data(), values.size(), rank);
}

Borders findBorders(const std::vector<StereoDepthResult::Point>& points) {
  std::vector<double> columns, disparities;
  columns.reserve(points.size());
  disparities.reserve(points.size());
  for (const StereoDepthResult::Point& point : points) {
    if (!point.on_plane) continue;
    columns.push_back(point.u);
    disparities.push_back(point.disparity);
  }
  if (columns.empty()) return {};
  Borders borders;
  borders.far = quantile(disparities, 1.0 / 3);
  borders.near = quantile(disparities, 2.0 / 3);
  borders.middle = quantile(columns, 0.5);
  return borders;
}

bool isIn(ImageRegion region, const Borders& borders, double u, double disparity) {
  switch (region) {
    case ImageRegion::kNear:
      return disparity > borders.near;
    case ImageRegion::kMiddle:
      return disparity > borders.far && disparity <= borders.near;
    case ImageRegion::kFar:
      return disparity <= borders.far;
    case ImageRegion::kLeft:
      return u <= borders.middle;
    case ImageRegion::kRight:
      return u > borders.middle;
  }
  return false;
}

}  // namespace

RegionPlanes planesWithoutRegions(const StereoRig& rig, const std::vector<StereoDepthResult::Point>& points,
                                  const PlaneVector& plane) {
  const PlaneLimits limits{kMaxAngle, kMaxAngle, kFewest, kTolerance};
  const Borders borders = findBorders(points);
  RegionPlanes planes;
  std::vector<DisparitySample> samples;
  samples.reserve(points.size());
  for (const StereoDepthResult::Point& point : points)
    samples.push_back({point.u, point.v, point.disparity_stddev, point.disparity});
  PlaneColumns memory;
  const Expected<PlaneFit> all = refinePlane(rig, {samples}, plane, limits, memory);
  if (!all) return planes;
  planes.all = all->plane;
  // Points are sorted by the disparity that the plane predicts, so an object on the ground belongs to the
  // ground behind it.
  std::vector<double> expected;
  expected.reserve(samples.size());
  for (const DisparitySample& sample : samples) expected.push_back(plane.disparity(rig, sample.u, sample.v));
  std::vector<DisparitySample> rest;
  rest.reserve(samples.size());
  for (int i = 0; i < kImageRegions; ++i) {
    rest.clear();
    for (size_t k = 0; k < samples.size(); ++k)
      if (!isIn(static_cast<ImageRegion>(i), borders, samples[k].u, expected[k])) rest.push_back(samples[k]);
    const Expected<PlaneFit> fit = refinePlane(rig, {rest}, plane, limits, memory);
    if (!fit) continue;
    planes.without[i] = fit->plane;
    const double least = planes.all.heightVariance() * all->count / fit->count;
    const double claimed = fit->plane.heightVariance();
    if (claimed < least) planes.without[i].covariance *= least / claimed;
  }
  return planes;
}

}  // namespace uav_landing
