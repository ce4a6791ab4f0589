#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <ostream>
#include <vector>

namespace uav_landing {
namespace benchmark {

/// Times of the same work, ms.
struct Times {
  std::vector<double> ms;

  double quantile(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::min(sorted.size() - 1,
                           static_cast<size_t>(share * static_cast<double>(sorted.size())))];
  }
  double median() const { return quantile(0.5); }

  /// As members of a JSON object.
  void write(std::ostream& out) const {
    out << "\"median\": " << median() << ", \"percentile_99\": " << quantile(0.99)
        << ", \"worst\": " << quantile(1);
  }
};

/// CPU time of this process, ms, so that other processes do not count.
inline double cpuMilliseconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace benchmark
}  // namespace uav_landing
