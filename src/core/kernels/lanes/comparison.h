#pragma once

#include <cstring>
#include <type_traits>

#include "kernels/lanes/lanes.h"

namespace uav_landing {

/// What one register holds of Vector where it is compared. GCC compares larger vectors element by element.
/// For x86-64 they stay whole, because the processor may have AVX2; a register of NEON holds half.
#if defined(__aarch64__)
constexpr int kComparedParts = 2;
#else
constexpr int kComparedParts = 1;
#endif
constexpr int kComparedBytes = sizeof(Lanes) / kComparedParts;
// One by one, because GCC ignores the attribute on a type that depends on a template.
template <class Number>
struct ComparedPart;
template <>
struct ComparedPart<float> {
  using Type = float __attribute__((vector_size(kComparedBytes)));
};
template <>
struct ComparedPart<int> {
  using Type = int __attribute__((vector_size(kComparedBytes)));
};
template <>
struct ComparedPart<double> {
  using Type = double __attribute__((vector_size(kComparedBytes)));
};
template <>
struct ComparedPart<long long> {
  using Type = long long __attribute__((vector_size(kComparedBytes)));
};

/// Calls compare(part of a, part of b, part of to) for all parts. It must be inlined.
template <class Vector, class Result, class Compare>
[[gnu::always_inline]] inline void compareByParts(const Vector& a, const Vector& b, Result& to,
                                                  const Compare& compare) {
  if constexpr (kComparedParts == 1) {
    compare(a, b, to);
  } else {
    using From = typename ComparedPart<std::decay_t<decltype(a[0])>>::Type;
    using To = typename ComparedPart<std::decay_t<decltype(to[0])>>::Type;
    From a_parts[kComparedParts], b_parts[kComparedParts];
    To to_parts[kComparedParts];
    std::memcpy(a_parts, &a, sizeof(Vector));
    std::memcpy(b_parts, &b, sizeof(Vector));
    for (int i = 0; i < kComparedParts; ++i) compare(a_parts[i], b_parts[i], to_parts[i]);
    std::memcpy(&to, to_parts, sizeof(Result));
  }
}

// In each of these NaN counts as a comparison that fails.
template <class Vector>
[[gnu::always_inline]] inline void smaller(const Vector& a, const Vector& b, Vector& to) {
  compareByParts(
      a, b, to, [](const auto& x, const auto& y, auto& of_both) __attribute__((always_inline)) {
        of_both = x < y ? x : y;
      });
}
template <class Vector>
[[gnu::always_inline]] inline void larger(const Vector& a, const Vector& b, Vector& to) {
  compareByParts(
      a, b, to, [](const auto& x, const auto& y, auto& of_both) __attribute__((always_inline)) {
        of_both = x > y ? x : y;
      });
}
/// -1 where a is less than b, else 0.
template <class Vector, class Mask>
[[gnu::always_inline]] inline void less(const Vector& a, const Vector& b, Mask& to) {
  compareByParts(
      a, b, to,
      [](const auto& x, const auto& y, auto& mask) __attribute__((always_inline)) { mask = x < y; });
}
/// -1 where a is at most b, else 0.
template <class Vector, class Mask>
[[gnu::always_inline]] inline void atMost(const Vector& a, const Vector& b, Mask& to) {
  compareByParts(
      a, b, to,
      [](const auto& x, const auto& y, auto& mask) __attribute__((always_inline)) { mask = x <= y; });
}

}  // namespace uav_landing
