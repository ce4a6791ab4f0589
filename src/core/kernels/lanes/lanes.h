#pragma once

#include <cstddef>
#include <cstring>

namespace uav_landing {

/// Eight floats for one instruction: one AVX register, or two of SSE or NEON. They serve sums over windows,
/// which compilers do not vectorise by themselves, as that changes the order. Pass them by reference only: by
/// value the registers would depend on the processor that a function is compiled for.
using Lanes = float __attribute__((vector_size(32)));
constexpr int kLanes = 8;

[[gnu::always_inline]] inline void load(const float* from, Lanes& to) {
  std::memcpy(&to, from, sizeof(Lanes));
}
[[gnu::always_inline]] inline void store(const Lanes& from, float* to) {
  std::memcpy(to, &from, sizeof(Lanes));
}

/// As many whole numbers. Comparisons of lanes give -1 where they hold, else 0.
using IntLanes = int __attribute__((vector_size(sizeof(Lanes))));

[[gnu::always_inline]] inline void store(const IntLanes& from, int* to) {
  std::memcpy(to, &from, sizeof(IntLanes));
}
/// Rounds towards zero.
[[gnu::always_inline]] inline void truncate(const Lanes& from, IntLanes& to) {
  to = __builtin_convertvector(from, IntLanes);
}
[[gnu::always_inline]] inline void convert(const IntLanes& from, Lanes& to) {
  to = __builtin_convertvector(from, Lanes);
}

/// Eight whole numbers as floats. It is written element by element, because the compiler then finds one
/// instruction; with loops or conversions of vectors it does not.
template <typename Number>
[[gnu::always_inline]] inline void convert(const Number* from, Lanes& to) {
  to = __builtin_convertvector(
      (IntLanes{from[0], from[1], from[2], from[3], from[4], from[5], from[6], from[7]}), Lanes);
}

/// start, start + step, ...
[[gnu::always_inline]] inline void progress(float start, float step, Lanes& to) {
  to = start + step * Lanes{0, 1, 2, 3, 4, 5, 6, 7};
}

[[gnu::always_inline]] inline float sum(const Lanes& lanes) {
  using Half = float __attribute__((vector_size(16)));
  const Half halves =
      Half{lanes[0], lanes[1], lanes[2], lanes[3]} + Half{lanes[4], lanes[5], lanes[6], lanes[7]};
  return (halves[0] + halves[2]) + (halves[1] + halves[3]);
}

/// The same for four doubles.
using DoubleLanes = double __attribute__((vector_size(32)));
constexpr int kDoubleLanes = 4;

[[gnu::always_inline]] inline void load(const double* from, DoubleLanes& to) {
  std::memcpy(&to, from, sizeof(DoubleLanes));
}
[[gnu::always_inline]] inline void store(const DoubleLanes& from, double* to) {
  std::memcpy(to, &from, sizeof(DoubleLanes));
}
[[gnu::always_inline]] inline double sum(const DoubleLanes& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

inline int wholeLanes(int count) { return (count + kLanes - 1) / kLanes * kLanes; }
inline size_t wholeDoubleLanes(size_t count) {
  return (count + kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes;
}

}  // namespace uav_landing
