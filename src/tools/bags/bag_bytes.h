#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace uav_landing {

/// Bytes that can be read at any position.
class BagBytes {
 public:
  virtual ~BagBytes() = default;
  virtual uint64_t size() const = 0;
  /// Copies count bytes, all of which must be within the size.
  virtual void copy(uint64_t from, size_t count, void* to) const = 0;
};

/// The bytes of a file. Only those asked for are read, but neighbouring bytes together. Throws
/// std::runtime_error when the file cannot be read.
class FileBytes : public BagBytes {
 public:
  explicit FileBytes(const std::string& path);
  ~FileBytes() override;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  uint64_t size() const override { return size_; }
  void copy(uint64_t from, size_t count, void* to) const override;

 private:
  void read(uint64_t from, size_t count, char* to) const;

  int file_;
  uint64_t size_ = 0;
  mutable std::array<char, 4096> window_;
  mutable uint64_t window_begin_ = 0;
  mutable size_t window_size_ = 0;
};

/// The bytes of a decompressed chunk.
class ChunkBytes : public BagBytes {
 public:
  explicit ChunkBytes(std::string content) : content_(std::move(content)) {}
  uint64_t size() const override { return content_.size(); }
  void copy(uint64_t from, size_t count, void* to) const override;

 private:
  std::string content_;
};

}  // namespace uav_landing
