#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// Chooses at most count of so many values, spread evenly over them. Ask it for each value, in their order.
class ThinnedPlaces {
 public:
  ThinnedPlaces(size_t values, size_t count) : values_(values), count_(count) {}
  bool has(size_t place) {
    if (values_ <= count_) return true;
    if (next_ >= count_ || place != next_ * values_ / count_) return false;
    ++next_;
    return true;
  }

 private:
  size_t values_, count_, next_ = 0;
};

template <class Value>
std::vector<Value> thinned(const std::vector<Value>& values, size_t count) {
  if (values.size() <= count) return values;
  std::vector<Value> some;
  some.reserve(count);
  ThinnedPlaces places(values.size(), count);
  for (size_t i = 0; i < values.size(); ++i)
    if (places.has(i)) some.push_back(values[i]);
  return some;
}

}  // namespace uav_landing
