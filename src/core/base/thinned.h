#pragma once

#include <cstddef>
#include <vector>

namespace uav_landing {

/// At most count of the values, spread as the values are.
template <class Value>
std::vector<Value> thinned(const std::vector<Value>& values, size_t count) {
  if (values.size() <= count) return values;
  std::vector<Value> some;
  some.reserve(count);
  for (size_t i = 0; i < count; ++i) some.push_back(values[i * values.size() / count]);
  return some;
}

}  // namespace uav_landing
