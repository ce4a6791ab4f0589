#pragma once

#include <filesystem>
#include <string>

namespace uav_landing {

/// A file that gets its name only when it is complete. It is written as "<path>.part" and renamed by
/// commit(); otherwise it is removed.
class PendingFile {
 public:
  explicit PendingFile(const std::string& path) : path_(path), temporary_(path + ".part") {}
  ~PendingFile() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::string& path() const { return path_; }
  const std::string& temporary() const { return temporary_; }
  /// Throws std::filesystem::filesystem_error when the file cannot be renamed.
  void commit() {
    std::filesystem::rename(temporary_, path_);
    committed_ = true;
  }

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

}  // namespace uav_landing
