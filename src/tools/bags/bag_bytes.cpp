#include "bags/bag_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace uav_landing {
namespace {

[[noreturn]] void failed() { throw std::runtime_error(std::strerror(errno)); }

}  // namespace

FileBytes::FileBytes(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (file_ < 0) failed();
  struct stat status {};
  if (fstat(file_, &status) != 0) {
    close(file_);
    failed();
  }
  size_ = static_cast<uint64_t>(status.st_size);
}

FileBytes::~FileBytes() { close(file_); }

void FileBytes::copy(uint64_t from, size_t count, void* to) const {
  if (count > window_.size()) return read(from, count, static_cast<char*>(to));
  if (from < window_begin_ || from + count > window_begin_ + window_size_) {
    window_size_ = static_cast<size_t>(std::min<uint64_t>(window_.size(), size_ - from));
    window_begin_ = from;
    read(from, window_size_, window_.data());
  }
  std::memcpy(to, window_.data() + (from - window_begin_), count);
}

void FileBytes::read(uint64_t from, size_t count, char* to) const {
  while (count > 0) {
    const ssize_t got = pread(file_, to, count, static_cast<off_t>(from));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) failed();
    if (got == 0) throw std::runtime_error("the file became shorter while it was read");
    from += static_cast<uint64_t>(got);
    to += got;
    count -= static_cast<size_t>(got);
  }
}

void ChunkBytes::copy(uint64_t from, size_t count, void* to) const {
  std::copy_n(content_.begin() + static_cast<std::ptrdiff_t>(from), count, static_cast<char*>(to));
}

}  // namespace uav_landing
