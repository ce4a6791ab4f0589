#include "uav_landing/base/timings.h"

#include <algorithm>
#include <numeric>

namespace uav_landing {

void Timings::add(const char* part, double ms) {
  const auto known =
      std::find_if(parts_.begin(), parts_.end(), [part](const auto& p) { return p.first == part; });
  if (known == parts_.end())
    parts_.emplace_back(part, ms);
  else
    known->second += ms;
}

double Timings::total() const {
  return std::accumulate(parts_.begin(), parts_.end(), 0.0,
                         [](double sum, const auto& part) { return sum + part.second; });
}

}  // namespace uav_landing
