#pragma once

#include <cstddef>

namespace uav_landing {
namespace benchmark {

/// While it exists, counts the memory that the program takes by operator new, which heap.cpp replaces. Only
/// one at a time.
class HeapCounter {
 public:
  /// least: bytes from which on memory counts as large as an image.
  explicit HeapCounter(std::size_t least);
  ~HeapCounter();
  HeapCounter(const HeapCounter&) = delete;
  HeapCounter& operator=(const HeapCounter&) = delete;

  std::size_t count() const;
  std::size_t large() const;
};

}  // namespace benchmark
}  // namespace uav_landing
