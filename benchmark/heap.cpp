#include "heap.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
std::atomic<std::size_t> calls{0}, large_calls{0}, threshold{kNever};
std::atomic<bool> counting{false};

}  // namespace

void* operator new(std::size_t size) {
  if (counting) {
    ++calls;
    if (size >= threshold) ++large_calls;
  }
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace uav_landing {
namespace benchmark {

HeapCounter::HeapCounter(std::size_t least) {
  calls = large_calls = 0;
  threshold = least;
  counting = true;
}
HeapCounter::~HeapCounter() { counting = false; }
std::size_t HeapCounter::count() const { return calls; }
std::size_t HeapCounter::large() const { return large_calls; }

}  // namespace benchmark
}  // namespace uav_landing
