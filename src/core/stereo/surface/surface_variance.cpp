#include "stereo/surface/surface_variance.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Share of the largest disparity that is near enough. Farther away a pixel is too much height to tell the
// surface.
constexpr double kNear = 0.4;
constexpr int kColumns = 10;  // square patches along a row of the image
constexpr int kRounds = 10;
constexpr size_t kFewest = 3;  // points that a patch needs

using Point = SurfaceMemory::Point;

// Share of the error that two matches have in common, because their windows share pixels.
double inCommon(const Point& a, const Point& b, int window) {
  const double across = std::abs(a.u - b.u), down = std::abs(a.v - b.v);
  return across < window && down < window ? (1 - across / window) * (1 - down / window) : 0;
}

struct Patch {
  double square;   // of the mean height, m^2
  double scatter;  // sum of squares about the mean, over the claimed variances
  double free;     // expected scatter on level ground, if matches scatter as claimed
  double of_mean;  // variance of the mean in that case, m^2
};

Patch patchOf(const std::vector<Point>& points, int window) {
  double weights = 0, sum = 0, squares = 0, shared = 0;  // shared: over all pairs of points, and each point
                                                         // with itself
  for (size_t i = 0; i < points.size(); ++i) {
    const double weight = points[i].precision * points[i].precision;
    weights += weight;
    sum += weight * points[i].height;
    squares += weight * points[i].height * points[i].height;
    shared += weight;
    for (size_t j = 0; j < i; ++j)
      shared += 2 * points[i].precision * points[j].precision * inCommon(points[i], points[j], window);
  }
  const double mean = sum / weights;
  return {mean * mean, squares - weights * mean * mean, static_cast<double>(points.size()) - shared / weights,
          shared / (weights * weights)};
}

/// Factor by which variances of matches exceed their claims, from the scatter within all patches together.
double inflation(const std::vector<Patch>& patches) {
  double scatter = 0, free = 0;
  for (const Patch& patch : patches) {
    scatter += patch.scatter;
    free += patch.free;
  }
  return free > 0 ? scatter / free : 0;
}

/// The variance that explains the squares of the patches' means beyond their expected scatter, m^2. of_mean:
/// m^2.
double varianceBetween(const std::vector<Patch>& patches) {
  double variance = 0;
  for (int i = 0; i < kRounds; ++i) {
    double excess = 0, slope = 0, weights = 0;
    for (const Patch& patch : patches) {
      const double weight = 1 / (patch.of_mean + variance);
      excess += patch.square * weight - 1;
      slope += patch.square * weight * weight;
      weights += weight;
    }
    // The means scatter less than expected, by chance, so there is no solution nearby. The mean excess stands
    // for it.
    if (i == 0 && excess <= 0) return excess / weights;
    variance += excess / slope;  // Newton's method, from the left of a convex function
  }
  return variance;
}

}  // namespace

double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window, SurfaceMemory& memory) {
  const Eigen::Vector3d row = rig.fb() * fit.plane.g;
  std::vector<double> expected;
  expected.reserve(samples.size());
  double largest = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    expected.push_back(row.dot(rig.ray(samples[i].u, samples[i].v)));
    if (fit.agrees[i]) largest = std::max(largest, expected[i]);
  }
  const double side = static_cast<double>(rig.size.width) / kColumns, unit = 1 / fit.plane.g.norm();
  const int rows = static_cast<int>(rig.size.height / side) + 1;
  std::vector<std::vector<Point>>& areas = memory.patches;
  areas.resize(static_cast<size_t>(kColumns * rows));
  for (std::vector<Point>& points : areas) points.clear();
  for (size_t i = 0; i < samples.size(); ++i) {
    const DisparitySample& sample = samples[i];
    if (!fit.agrees[i] || expected[i] < kNear * largest) continue;
    const int across = std::clamp(static_cast<int>(sample.u / side), 0, kColumns - 1);
    const int down = std::clamp(static_cast<int>(sample.v / side), 0, rows - 1);
    areas[static_cast<size_t>(across * rows + down)].push_back(
        {sample.u, sample.v, unit * (sample.disparity - expected[i]) / expected[i],
         expected[i] / (unit * sample.stddev)});
  }
  std::vector<Patch> patches;
  for (const std::vector<Point>& points : areas)
    if (points.size() >= kFewest) patches.push_back(patchOf(points, window));

  const double factor = inflation(patches);
  if (!(factor > 0)) return 0;
  for (Patch& patch : patches) patch.of_mean *= factor;
  return varianceBetween(patches);
}

double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window) {
  SurfaceMemory memory;
  return surfaceVariance(rig, samples, fit, window, memory);
}

}  // namespace uav_landing
