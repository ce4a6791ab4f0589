#pragma once

#include <atomic>
#include <opencv2/core.hpp>

namespace uav_landing {
namespace benchmark {

/// While it exists, counts the matrices of at least this many bytes that OpenCV allocates.
class ImageAllocations : public cv::MatAllocator {
 public:
  explicit ImageAllocations(size_t least) : least_(least), standard_(cv::Mat::getStdAllocator()) {
    cv::Mat::setDefaultAllocator(this);
  }
  ~ImageAllocations() override { cv::Mat::setDefaultAllocator(standard_); }
  ImageAllocations(const ImageAllocations&) = delete;
  ImageAllocations& operator=(const ImageAllocations&) = delete;

  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, size_t* step, cv::AccessFlag flags,
                         cv::UMatUsageFlags usage) const override {
    // The matrix belongs to the standard allocator, because it may outlive this one.
    cv::UMatData* image = standard_->allocate(dims, sizes, type, data, step, flags, usage);
    if (data == nullptr && image->size >= least_) ++count_;
    return image;
  }
  bool allocate(cv::UMatData* image, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return standard_->allocate(image, flags, usage);
  }
  void deallocate(cv::UMatData* image) const override { standard_->deallocate(image); }

  int count() const { return count_; }

 private:
  size_t least_;
  cv::MatAllocator* standard_;
  mutable std::atomic<int> count_{0};
};

}  // namespace benchmark
}  // namespace uav_landing
