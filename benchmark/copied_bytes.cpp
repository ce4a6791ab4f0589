#include "copied_bytes.h"

#include <atomic>

namespace {
std::atomic<std::size_t> copied{0};
}  // namespace

// The functions in which the C library's own copies end. A program's definition of memcpy comes before the
// library's for all libraries that it loads.
extern "C" {
void* __memcpy_chk(void* to, const void* from, std::size_t size, std::size_t room);
void* __memmove_chk(void* to, const void* from, std::size_t size, std::size_t room);

void* memcpy(void* __restrict to, const void* __restrict from, std::size_t size) {
  copied.fetch_add(size, std::memory_order_relaxed);
  return __memcpy_chk(to, from, size, size);
}
void* memmove(void* to, const void* from, std::size_t size) {
  copied.fetch_add(size, std::memory_order_relaxed);
  return __memmove_chk(to, from, size, size);
}
}

namespace uav_landing {
namespace benchmark {

std::size_t copiedBytes() { return copied; }

}  // namespace benchmark
}  // namespace uav_landing
