#pragma once

#include <cstddef>

namespace uav_landing {
namespace benchmark {

/// While it lives, counts what the program takes by operator new, which its program (heap.cpp) replaces. One
/// at a time.
class HeapCounter {
 public:
  /// least: bytes from which on memory is as large as an image.
  explicit HeapCounter(std::size_t least);
  ~HeapCounter();
  HeapCounter(const HeapCounter&) = delete;
  HeapCounter& operator=(const HeapCounter&) = delete;

  std::size_t count() const;
  std::size_t large() const;
};

}  // namespace benchmark
}  // namespace uav_landing
