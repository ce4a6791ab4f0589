#include "image/window_overlap.h"

#include <Eigen/Core>
#include <algorithm>

namespace uav_landing {

WindowOverlap::WindowOverlap(size_t count) {
  for (std::vector<float>* values : {&u_, &v_, &extents_, &lowest_}) values->reserve(count);
}

void WindowOverlap::add(double u, double v, double extent) {
  u_.push_back(static_cast<float>(u));
  v_.push_back(static_cast<float>(v));
  extents_.push_back(static_cast<float>(extent));
  lowest_.push_back(lowest_.empty() ? v_.back() : std::max(lowest_.back(), v_.back()));
}

double WindowOverlap::factor() const {
  if (u_.empty()) return 1;
  double sum = 0;
  for (size_t i = 0; i < u_.size(); ++i)
    if (extents_[i] > 0) sum += 2 * shared(i);
  return 1 + sum / static_cast<double>(u_.size());
}

// Sum of the shares that the windows before have of this one.
float WindowOverlap::shared(size_t i) const {
  using Array = Eigen::Map<const Eigen::ArrayXf>;
  const size_t first = firstNear(i);
  const float share = 1 / extents_[i];
  const auto inside = [&](const std::vector<float>& places) {
    const Array before(places.data() + first, static_cast<Eigen::Index>(i - first));
    return (1 - share * (before - places[i]).abs()).max(0.0F).eval();
  };
  return (inside(u_) * inside(v_)).sum();
}

// All before it are too far above. Whole blocks, so that sums are rounded as those over all.
size_t WindowOverlap::firstNear(size_t i) const {
  constexpr size_t kBlock = 8;
  const float far = v_[i] - extents_[i] - 1;
  const auto end = lowest_.begin() + static_cast<std::ptrdiff_t>(i);
  return static_cast<size_t>(std::lower_bound(lowest_.begin(), end, far) - lowest_.begin()) / kBlock * kBlock;
}

}  // namespace uav_landing
