#include "uav_landing/surface_variance.h"

#include <algorithm>

namespace uav_landing {

double surfaceVariance(const StereoRig& rig, const std::vector<DisparitySample>& samples,
                       const PlaneFit& fit) {
  // Share of the largest disparity; farther away a pixel is too much height to say anything of the surface.
  constexpr double kNear = 0.4;
  constexpr int kColumns = 10;  // patches along a row of the image; square
  constexpr int kFewest = 3;    // points of a patch
  struct Patch {
    int count = 0;
    double sum = 0, squares = 0;
  };
  const Eigen::Vector3d row = rig.fb() * fit.plane.g;
  double largest = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (fit.agrees[i]) largest = std::max(largest, row.dot(rig.ray(samples[i].u, samples[i].v)));
  }
  const double side = static_cast<double>(rig.size.width) / kColumns, unit = 1 / fit.plane.g.norm();
  const int rows = static_cast<int>(rig.size.height / side) + 1;
  std::vector<Patch> patches(static_cast<size_t>(kColumns * rows));
  for (size_t i = 0; i < samples.size(); ++i) {
    const double expected = row.dot(rig.ray(samples[i].u, samples[i].v));
    if (!fit.agrees[i] || expected < kNear * largest) continue;
    const double height = unit * (samples[i].disparity - expected) / expected;
    const int across = std::clamp(static_cast<int>(samples[i].u / side), 0, kColumns - 1);
    const int down = std::clamp(static_cast<int>(samples[i].v / side), 0, rows - 1);
    Patch& patch = patches[static_cast<size_t>(across * rows + down)];
    ++patch.count;
    patch.sum += height;
    patch.squares += height * height;
  }
  double scatter = 0, means = 0, of_scatter = 0;
  int points = 0, used = 0;
  for (const Patch& patch : patches) {
    if (patch.count < kFewest) continue;
    ++used;
    points += patch.count;
    const double mean = patch.sum / patch.count;
    scatter += patch.squares - patch.count * mean * mean;
    means += mean * mean;
    of_scatter += 1.0 / patch.count;
  }
  if (used == 0) return 0;
  const double within = scatter / (points - used);
  return (means - of_scatter * within) / used;
}

}  // namespace uav_landing
