#pragma once

#include <cstddef>

namespace uav_landing {
namespace benchmark {

/// Bytes that all threads have copied by memcpy and memmove, which the program (copied_bytes.cpp) replaces,
/// since it began. Copies of a size known to the compiler, a few bytes, are not calls and not counted.
std::size_t copiedBytes();

}  // namespace benchmark
}  // namespace uav_landing
