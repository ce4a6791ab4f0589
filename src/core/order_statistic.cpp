#include "order_statistic.h"

#include <limits>

#include "multiversion.h"

namespace uav_landing {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kFew = 2;     // values in a range that are looked at one by one
constexpr int kTries = 10;  // limits before that, where many values are the same

using IntLanes = int __attribute__((vector_size(32)));

[[gnu::always_inline]] inline int sumOf(const IntLanes& n) {
  return ((n[0] + n[4]) + (n[2] + n[6])) + ((n[1] + n[5]) + (n[3] + n[7]));
}

[[gnu::always_inline]] inline int countBelow(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  IntLanes below{};
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    below -= v < limits;
  }
  return sumOf(below);
}

[[gnu::always_inline]] inline int countUpTo(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit;
  IntLanes up_to{};
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    up_to -= v <= limits;
  }
  return sumOf(up_to);
}

/// The smallest of the values that are larger than a limit, or as large.
[[gnu::always_inline]] inline float smallestFrom(const float* values, int count, float limit) {
  const Lanes limits = Lanes{} + limit, infinity = Lanes{} + kInfinity;
  Lanes smallest = infinity;
  for (int i = 0; i < count; i += kLanes) {
    Lanes v;
    load(values + i, v);
    const Lanes candidate = v >= limits ? v : infinity;
    smallest = candidate < smallest ? candidate : smallest;
  }
  float result = smallest[0];
  for (int i = 1; i < kLanes; ++i) result = smallest[i] < result ? smallest[i] : result;
  return result;
}

}  // namespace

UAV_LANDING_MULTIVERSION float orderStatistic(const float* values, int count, int rank, float guess) {
  // What is looked for is in [low, high): below_low values are smaller than low, below_high than high.
  float low = 0, high = kInfinity, limit = guess;
  int below_low = 0, below_high = count;
  for (int i = 0; i < kTries && below_high - below_low > kFew && limit > low && limit < high; ++i) {
    const int below = countBelow(values, count, limit);
    if (below == rank) return smallestFrom(values, count, limit);
    (below < rank ? low : high) = limit;
    (below < rank ? below_low : below_high) = below;
    const float share =
        (static_cast<float>(rank - below_low) + 0.5F) / static_cast<float>(below_high - below_low);
    limit = high < kInfinity ? low + share * (high - low) : 2 * limit;
  }
  for (;;) {
    const float next = smallestFrom(values, count, low);
    if (!(next < kInfinity) || countUpTo(values, count, next) > rank) return next;
    low = __builtin_nextafterf(next, kInfinity);
  }
}

}  // namespace uav_landing
