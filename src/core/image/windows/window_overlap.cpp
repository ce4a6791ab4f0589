#include "image/windows/window_overlap.h"

#include <algorithm>

#include "kernels/lanes/lanes.h"
#include "kernels/samples/shares.h"

namespace uav_landing {
WindowOverlap::WindowOverlap(size_t count) {
  for (std::vector<float>* values : {&u_, &v_, &extents_, &lowest_}) values->reserve(count + kLanes);
}

void WindowOverlap::add(double u, double v, double extent) {
  if (count_ == u_.size())
    for (std::vector<float>* values : {&u_, &v_, &extents_, &lowest_}) values->resize(count_ + kLanes);
  u_[count_] = static_cast<float>(u);
  v_[count_] = static_cast<float>(v);
  extents_[count_] = static_cast<float>(extent);
  lowest_[count_] = count_ == 0 ? v_[0] : std::max(lowest_[count_ - 1], v_[count_]);
  ++count_;
}

double WindowOverlap::factor() const {
  if (count_ == 0) return 1;
  double sum = 0;
  for (size_t i = 0; i < count_; ++i)
    if (extents_[i] > 0) sum += 2 * shared(i);
  return 1 + sum / static_cast<double>(count_);
}

// Sum of the shares that earlier windows have of this one.
float WindowOverlap::shared(size_t i) const {
  return sumOfShares(u_.data(), v_.data(), firstNear(i), i, {u_[i], v_[i], extents_[i]});
}

// First window that is not too far above this one. Whole blocks, so that they end where the columns do.
size_t WindowOverlap::firstNear(size_t i) const {
  const auto end = lowest_.begin() + static_cast<std::ptrdiff_t>(i);
  const auto near = std::lower_bound(lowest_.begin(), end, v_[i] - extents_[i]);
  return static_cast<size_t>(near - lowest_.begin()) / kLanes * kLanes;
}

}  // namespace uav_landing
