#include "kernels/lanes/order_statistic.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "kernels/lanes/comparison.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kFew = 2;   // values in a range that are looked at one by one
constexpr int kSlow = 3;  // limits in a row that leave most of a range; then the smallest value is looked at

[[gnu::always_inline]] inline int sumOf(const IntLanes& n) {
  return ((n[0] + n[4]) + (n[2] + n[6])) + ((n[1] + n[5]) + (n[3] + n[7]));
}

[[gnu::always_inline]] inline int countBelow(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  IntLanes below{};
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    IntLanes less_here;
    less(v, limits, less_here);
    below -= less_here;
  }
  return sumOf(below);
}

[[gnu::always_inline]] inline int countUpTo(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  IntLanes up_to{};
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    IntLanes at_most_here;
    atMost(v, limits, at_most_here);
    up_to -= at_most_here;
  }
  return sumOf(up_to);
}

/// The values that are not below a limit, and infinity in place of the others.
[[gnu::always_inline]] inline void keepFrom(const Lanes& v, const Lanes& limits, Lanes& kept) {
  compareByParts(
      v, limits, kept, [](const auto& x, const auto& limit, auto& to) __attribute__((always_inline)) {
        to = x >= limit ? x : std::decay_t<decltype(x)>{} + kInfinity;
      });
}
/// The values below a limit, and minus infinity in place of the others.
[[gnu::always_inline]] inline void keepBelow(const Lanes& v, const Lanes& limits, Lanes& kept) {
  compareByParts(
      v, limits, kept, [](const auto& x, const auto& limit, auto& to) __attribute__((always_inline)) {
        to = x < limit ? x : std::decay_t<decltype(x)>{} - kInfinity;
      });
}

/// The smallest value that is not below a limit.
[[gnu::always_inline]] inline float smallestFrom(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  Lanes smallest = Lanes{} + kInfinity;
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    Lanes candidate;
    keepFrom(v, limits, candidate);
    smaller(candidate, smallest, smallest);
  }
  float result = smallest[0];
  for (int i = 1; i < kLanes; ++i) result = smallest[i] < result ? smallest[i] : result;
  return result;
}

/// The largest value below a limit; there must be one.
[[gnu::always_inline]] inline float largestBelow(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  Lanes largest = Lanes{} - kInfinity;
  UAV_LANDING_UNROLL
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    Lanes candidate;
    keepBelow(v, limits, candidate);
    larger(candidate, largest, largest);
  }
  float result = largest[0];
  for (int i = 1; i < kLanes; ++i) result = largest[i] > result ? largest[i] : result;
  return result;
}

}  // namespace

double orderStatistic(const double* values, size_t count, size_t rank) {
  std::vector<double> finite;
  finite.reserve(count);
  std::copy_if(values, values + count, std::back_inserter(finite), [](double v) { return std::isfinite(v); });
  if (rank >= finite.size()) return std::numeric_limits<double>::quiet_NaN();
  const auto wanted = finite.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(finite.begin(), wanted, finite.end());
  return *wanted;
}

UAV_LANDING_MULTIVERSION float orderStatistic(const float* values, int count, int rank, float guess) {
  // The value is in [low, high): below_low values are smaller than low, below_high than high.
  float low = 0, high = kInfinity, limit = guess;
  int below_low = 0, below_high = count, slow = 0;
  for (;;) {
    const int inside = below_high - below_low;
    if (inside > kFew && slow < kSlow && limit > low && limit < high) {
      const int below = countBelow(values, count, limit);
      if (below == rank) return smallestFrom(values, count, limit);
      if (below == rank + 1) return largestBelow(values, count, limit);
      (below < rank ? low : high) = limit;
      (below < rank ? below_low : below_high) = below;
      // Many values may be equal, or far from the others.
      slow = 4 * (below_high - below_low) > 3 * inside ? slow + 1 : 0;
    } else {
      const float next = smallestFrom(values, count, low);
      if (!(next < kInfinity)) return next;
      const int up_to = countUpTo(values, count, next);
      if (up_to > rank) return next;
      low = __builtin_nextafterf(next, kInfinity);
      below_low = up_to;
      slow = 0;
    }
    if (high < kInfinity) {
      const float share =
          (static_cast<float>(rank - below_low) + 0.5F) / static_cast<float>(below_high - below_low);
      limit = low + (slow > 0 ? 0.5F : share) * (high - low);
    } else {
      limit *=
          std::min(2.F, 1.1F * static_cast<float>(rank + 1) / static_cast<float>(std::max(below_low, 1)));
    }
  }
}

}  // namespace uav_landing
