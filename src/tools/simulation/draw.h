#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace uav_landing {

/// Makes seeds that differ by 1 completely different (the finaliser of SplitMix64, Steele et al. 2014),
/// because cv::RNG's first numbers after similar seeds are similar.
inline uint64_t hashed(uint64_t seed) {
  seed += 0x9E3779B97F4A7C15ULL;
  seed = (seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9ULL;
  seed = (seed ^ (seed >> 27)) * 0x94D049BB133111EBULL;
  return seed ^ (seed >> 31);
}

/// Uses cv::RNG instead of the standard header `random`, to get the same numbers with every standard library.
class Draw {
 public:
  explicit Draw(uint64_t seed) : random_(hashed(seed)) {}
  double uniform(double from, double to) { return random_.uniform(from, to); }
  /// A size for which factors count: equally often between 1 and 2 as between 2 and 4.
  double scale(double from, double to) { return from * std::exp(uniform(0, std::log(to / from))); }
  double normal(double stddev) { return random_.gaussian(stddev); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  int seed() { return random_.uniform(0, 1000000000); }

 private:
  cv::RNG random_;
};

}  // namespace uav_landing
