#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

namespace uav_landing {
namespace fuzz {

/// A file in memory with a path, for readers that want one.
class MemoryFile {
 public:
  MemoryFile(const void* data, size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    written_ = descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size);
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool written() const { return written_; }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
  bool written_;
};

}  // namespace fuzz
}  // namespace uav_landing
