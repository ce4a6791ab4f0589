#include "uav_landing/surface_variance.h"

#include <algorithm>
#include <cmath>

namespace uav_landing {
namespace {

// Share of the largest disparity; farther away a pixel is too much height to say anything of the surface.
constexpr double kNear = 0.4;
constexpr int kColumns = 10;   // patches along a row of the image; square
constexpr size_t kFewest = 3;  // points of a patch

struct Point {
  double u, v, height;
};

// Share of the error that two matches have in common: that of the pixels that both their windows are of.
double inCommon(const Point& a, const Point& b, int window) {
  const double across = 1 - std::abs(a.u - b.u) / window, down = 1 - std::abs(a.v - b.v) / window;
  return across > 0 && down > 0 ? across * down : 0;
}

// What a patch adds to the sums over all.
struct Patch {
  double square = 0;   // of the mean height, m^2
  double scatter = 0;  // sum of squares about the mean, m^2
  double free = 0;     // by how many variances of a point the scatter is expected to be
  double of_mean = 0;  // the same of the square of the mean
};

Patch patchOf(const std::vector<Point>& points, int window) {
  const double count = static_cast<double>(points.size());
  double sum = 0, squares = 0, shared = count;  // shared: of all pairs of points, each with itself, too
  for (size_t i = 0; i < points.size(); ++i) {
    sum += points[i].height;
    squares += points[i].height * points[i].height;
    for (size_t j = 0; j < i; ++j) shared += 2 * inCommon(points[i], points[j], window);
  }
  const double mean = sum / count;
  return {mean * mean, squares - count * mean * mean, count - shared / count, shared / (count * count)};
}

}  // namespace

double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples, const PlaneFit& fit,
                       int window) {
  const Eigen::Vector3d row = rig.fb() * fit.plane.g;
  double largest = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (fit.agrees[i]) largest = std::max(largest, row.dot(rig.ray(samples[i].u, samples[i].v)));
  }
  const double side = static_cast<double>(rig.size.width) / kColumns, unit = 1 / fit.plane.g.norm();
  const int rows = static_cast<int>(rig.size.height / side) + 1;
  std::vector<std::vector<Point>> patches(static_cast<size_t>(kColumns * rows));
  for (size_t i = 0; i < samples.size(); ++i) {
    const DisparitySample& sample = samples[i];
    const double expected = row.dot(rig.ray(sample.u, sample.v));
    if (!fit.agrees[i] || expected < kNear * largest) continue;
    const int across = std::clamp(static_cast<int>(sample.u / side), 0, kColumns - 1);
    const int down = std::clamp(static_cast<int>(sample.v / side), 0, rows - 1);
    patches[static_cast<size_t>(across * rows + down)].push_back(
        {sample.u, sample.v, unit * (sample.disparity - expected) / expected});
  }
  Patch sums;
  int used = 0;
  for (const std::vector<Point>& points : patches) {
    if (points.size() < kFewest) continue;
    const Patch patch = patchOf(points, window);
    ++used;
    sums.square += patch.square;
    sums.scatter += patch.scatter;
    sums.free += patch.free;
    sums.of_mean += patch.of_mean;
  }
  if (!(sums.free > 0)) return 0;
  return (sums.square - sums.of_mean * sums.scatter / sums.free) / used;
}

}  // namespace uav_landing
