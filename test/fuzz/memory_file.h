#pragma once

#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

namespace uav_landing {
namespace fuzz {

/// Where files cost no disk, as far as there is such a place.
inline std::filesystem::path memoryFolder() {
  namespace fs = std::filesystem;
  return fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
}

/// A file for readers that want a path, in memory where there is a file system for that. ending: of the name,
/// which some readers go by.
class MemoryFile {
 public:
  MemoryFile(const void* data, size_t size, const std::string& ending) {
    path_ = memoryFolder() / ("uav_landing_fuzz_" + std::to_string(getpid()) + ending);
    std::ofstream file(path_, std::ios::binary);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    written_ = static_cast<bool>(file.flush());
  }
  ~MemoryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool written() const { return written_; }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
  bool written_ = false;
};

}  // namespace fuzz
}  // namespace uav_landing
